// The derivative of a closing's cost: what each figure behind the cost gives to the motion's derivative, and their sum as the
// cost weighs them.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "model/linearized_closing.h"
#include "objectives/cost.h"

namespace softland {

/// Of the speed of the first touch: a crossing of the plane that is slower grazes.
inline constexpr double grazing_share = 0.1;

/// Of the figures of CostFigures of the same name. A crossing of the plane happens at a time that moves with the motion; a height
/// or a depth is that of a turning point, whose time does not matter. The largest of several is followed.
struct CostSlopes {
  FigureSlope closest, first_touch, touch_speed, rebound_height, separated, last_rebound_end, impact_energy, landing_excess,
      peak_force;
  FigureSlope first_touch_speed;  ///< no figure of a cost: Metrics::impact_velocity
  /// False where the peak force is not that of the deepest point: on damped contacts, and along a pad.
  bool has_peak_force = true;
  /// False along a pad, which stores its energy all along it.
  bool has_impact_energy = true;
  /// Whether a rebound is under way at the end of the run, which no derivative knows: last_rebound_end and separated leave it
  /// out.
  bool ends_above = false;
  /// Slowest crossing of the plane over the speed of the first touch: where it is small, a touch is about to begin or to go, and
  /// derivatives hold in a small neighbourhood only. 1 where there is one touch.
  double grazing = 1;
};
/// Of the closing whose figures and motion these are. The drive energy has no slope here.
[[nodiscard]] CostSlopes cost_slopes(const Switch& model, std::span<const Signal> signals, const LinearizedClosing& motion,
                                     const MetricsOptions& options);

/// A figure of merit that has a slope, by its key in results.
struct FigureWithSlope {
  std::string_view key;
  FigureSlope CostSlopes::*slope;
};
inline constexpr auto figures_with_slopes =
    std::to_array<FigureWithSlope>({{"initial_contact_time_s", &CostSlopes::first_touch},
                                    {"permanent_contact_time_s", &CostSlopes::last_rebound_end},
                                    {"major_bounce_height_m", &CostSlopes::rebound_height},
                                    {"impact_velocity_m_s", &CostSlopes::first_touch_speed},
                                    {"largest_impact_velocity_m_s", &CostSlopes::touch_speed},
                                    {"peak_contact_force_N", &CostSlopes::peak_force},
                                    {"impact_energy_J", &CostSlopes::impact_energy}});

/// None where the cost is infinite, or about a figure that has no slope.
[[nodiscard]] std::optional<FigureSlope> cost_slope(const Aim& aim, Status status, const CostFigures& figures,
                                                    const CostScale& scale, const MetricsOptions& options,
                                                    const CostSlopes& slopes);

}  // namespace softland
