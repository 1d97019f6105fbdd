// A pace estimates the remaining time of a computation. The first class is for an exploration that computes some of its points
// and takes others over from earlier plans, which is quick.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace softland::apps {

struct Pace {
  std::int64_t remaining = 0;  ///< points that are neither stored nor taken yet
  std::int64_t computed = 0, reused = 0;
  std::int64_t earlier = 0;  ///< rows of earlier plans: at most as many points can be taken over
  double seconds = 0;        ///< time since the first computed point began [s]

  /// Returns the number of points still to compute. Some of the remaining ones are taken over: as many as earlier rows are
  /// left, or the same share as until now, whichever is less. NaN before anything was taken.
  [[nodiscard]] double to_compute() const;
  /// Returns the remaining time [s]; NaN before anything was computed.
  [[nodiscard]] double seconds_left() const;
};

/// The progress of a computation that consists of several, one after the other.
class WorkPace {
 public:
  /// Notes that `part`, 0 to 1, of `what` is done `elapsed` [s] after the whole began; another `what` begins anew.
  void note(std::string_view what, double part, double elapsed);
  /// Returns "closing: 43 %, 12 s, about 16 s left". The last part appears when it is known, for the current computation alone.
  [[nodiscard]] std::string words(double elapsed) const;

 private:
  std::string what_;
  double began_ = 0, first_part_ = 0, part_ = 0;
};

}  // namespace softland::apps
