// A switch that stays open: where its hold levels bring it to rest, how it gets there, and whether it was meant to close.
#pragma once

#include <vector>

#include "base/watch.h"
#include "model/switch.h"
#include "model/trajectory.h"
#include "objectives/metrics.h"
#include "waveforms/signal.h"

namespace softland {

/// Of the largest distance of the contact point from its static deflection: it has settled where it stays this near.
inline constexpr double settled_share = 0.02;

/// Sets static_deflection, overshoot and open_settling_time of a run that came to its end without a touch, or that began closed
/// and has left its contact, where the hold levels of these drives have a stable open equilibrium; leaves them unset elsewhere.
/// It has not settled where it came near less than a period of the first mode before the end. A run that began closed is done
/// where it has settled.
void set_open_figures(Metrics& metrics, const Trajectory& run, const Switch& model, const std::vector<Signal>& signals);

/// Whether these drives ask for no closing: their hold levels have a stable open equilibrium, and so has the least and the most
/// that each of them gives in the window [s], the others at their hold levels; and no step of an electrode, or of the dispersion
/// force, to the most that it gives reaches the contact plane, so that none is at its dynamic pull-in voltage.
[[nodiscard]] bool stays_open(const Switch& model, const std::vector<Signal>& signals, double duration, const Watch& watch = {});

}  // namespace softland
