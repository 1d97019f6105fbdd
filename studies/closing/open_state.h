// A switch that stays open: the rest position under its hold levels, the motion to this position, and whether the drives are
// meant to close the switch.
#pragma once

#include <vector>

#include "base/progress.h"
#include "model/switch.h"
#include "model/trajectory.h"
#include "objectives/metrics.h"
#include "waveforms/signal.h"

namespace softland {

/// In a run that stays open, the contact point has settled when its distance from the static deflection stays below this share
/// of the largest distance in the run.
inline constexpr double settled_share = 0.02;

/// Sets static_deflection, overshoot and open_settling_time of a run that ended without contact, or that began closed and has
/// opened. The figures need a stable open equilibrium under the hold levels of the drives, and stay unset without one. The run
/// has not settled if it came near the equilibrium less than a period of the first mode before the end. A run that began closed
/// is done if it has settled.
void set_open_figures(Metrics& metrics, const Trajectory& run, const Switch& model, const std::vector<Signal>& signals);

/// True if these drives are not meant to close the switch. A stable open equilibrium must exist under the hold levels, and
/// under the least and the largest value of each drive within `duration` [s], with the others at their hold levels. A step of a
/// single electrode (or of the factor of the dispersion force) to its largest value must not reach the contact plane, as a step
/// above dynamic pull-in does.
[[nodiscard]] bool stays_open(const Switch& model, const std::vector<Signal>& signals, double duration,
                              const Progress& progress = {});

}  // namespace softland
