// Figures of an opening: how a closed switch lets go, and how long it swings once it has. Taken at the contact point, like those
// of a closing.
#pragma once

#include <limits>

#include "model/trajectory.h"

namespace softland {

struct OpeningBand {
  double open_position = 0;  ///< of the contact point at rest under the open drives [m]
  double width = 0;          ///< the switch is open for good once it stays this near [m]
  double drives_end = 0;     ///< from when on the drives stand at their open levels [s]
};

/// How the contact point comes to rest in a band.
struct BandFigures {
  double settled_from = std::numeric_limits<double>::quiet_NaN();  ///< from when on it stays in the band [s]; NaN: it does not
  double below = 0, above = 0;  ///< furthest from the open position, away from the contact and towards it [m]; 0 if never
  double residual = std::numeric_limits<double>::quiet_NaN();  ///< OpeningFigures::residual_vibration
};
/// Between knots the motion is the quintic through them.
[[nodiscard]] BandFigures band_figures(const Trajectory& course, const OpeningBand& band);

struct OpeningFigures {
  static constexpr double unset = std::numeric_limits<double>::quiet_NaN();

  /// done: it opens, and stays in the band until the end of the window. not_settled: it is closed at the end, or outside the
  /// band. Else that of the run.
  Status status = Status::not_run;
  double release_time = unset;   ///< the contact point leaves the contact for good [s]; NaN while it is closed at the end
  double settling_time = unset;  ///< from when on it stays in the band [s]; NaN where it does not
  double overshoot = unset;      ///< furthest beyond its open position, away from the contact [m]; 0 if never
  double residual_vibration =
      unset;        ///< largest distance from the open position once the drives stand [m]; NaN before that, or while closed
  int touches = 0;  ///< of the contact after it has first left it
};

/// Of an opening (ClosingOptions::begins_closed). Of a run that did not come to its end the status alone.
[[nodiscard]] OpeningFigures release_figures(const Trajectory& opening, const OpeningBand& band);

}  // namespace softland
