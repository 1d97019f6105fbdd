// How long an exploration will take that computes some of its points and takes others over from earlier plans, which is quick.
#pragma once

#include <cstdint>

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

}  // namespace softland::apps
