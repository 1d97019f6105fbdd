// Estimates the remaining time of a computation. Pace is for an exploration of a design space, in which some points are
// simulated, and others are copied from earlier results in almost no time. WorkPace is for a computation in stages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace softland::apps {

struct Pace {
  std::int64_t remaining = 0;  ///< points of the exploration that are neither computed nor copied yet
  std::int64_t computed = 0, reused = 0;
  /// Number of results of earlier explorations, an upper bound of the points that can still be copied.
  std::int64_t earlier = 0;
  double seconds = 0;  ///< time since the first point without an earlier result was begun [s]

  /// Returns the estimated number of points still to compute, if the share of copied points stays as it is, and at most
  /// `earlier` points are copied. NaN before the first point is done.
  [[nodiscard]] double to_compute() const;
  /// Returns the remaining time of an exploration [s]; NaN before the first point is computed.
  [[nodiscard]] double seconds_left() const;
};

/// The progress of a computation that consists of several stages in sequence.
class WorkPace {
 public:
  /// Records that the share `part`, 0 to 1, of stage `what` is done at `elapsed` [s] after the start. Another name begins a new
  /// stage.
  void note(std::string_view what, double part, double elapsed);
  /// Returns the remaining time of the current stage [s]; none at its end, and until it can be estimated.
  [[nodiscard]] std::optional<double> seconds_left(double elapsed) const;
  /// Returns the progress as text: "closing: 43 %, 12 s, about 16 s left", with seconds_left() if there is one.
  [[nodiscard]] std::string words(double elapsed) const;

 private:
  std::optional<std::string> what_;  // name of the current stage, which may be empty; none before the first note
  double began_ = 0, first_part_ = 0, part_ = 0;
};

}  // namespace softland::apps
