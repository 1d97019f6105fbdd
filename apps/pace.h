// How long a computation will take; first, an exploration that computes some of its points and takes others over from earlier
// plans, which is quick.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace softland::apps {

struct Pace {
  std::int64_t remaining = 0;  ///< points that are neither there nor taken yet
  std::int64_t computed = 0, reused = 0;
  std::int64_t earlier = 0;  ///< rows of earlier plans: as many points can be taken over at the most
  double seconds = 0;        ///< since the first point was begun that had to be computed [s]

  /// Points that are to be computed still: of what remains as many are taken over as there are earlier rows left, or as until
  /// now, whichever is less. NaN before anything was taken.
  [[nodiscard]] double to_compute() const;
  /// [s]; NaN before anything was computed.
  [[nodiscard]] double seconds_left() const;
};

/// How far a computation is that consists of several, one after the other.
class WorkPace {
 public:
  /// `part`, 0 to 1, of `what` is done `elapsed` [s] after the whole began; another `what` begins anew.
  void note(std::string_view what, double part, double elapsed);
  /// "closing: 43 %, 12 s, about 16 s left", the last as long as that is known: of what is done now, not of what follows it.
  [[nodiscard]] std::string words(double elapsed) const;

 private:
  std::string what_;
  double began_ = 0, first_part_ = 0, part_ = 0;
};

}  // namespace softland::apps
