// The derivative of a closing's cost: what each figure behind the cost gives to the motion's derivative, and their sum as the
// cost weighs them.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "model/linearized_closing.h"
#include "objectives/cost.h"

namespace softland {

/// Of the speed of the first touch: a crossing of the plane that is slower grazes.
inline constexpr double grazing_share = 0.1;

/// A crossing of the plane happens at a time that moves with the motion; a height or a depth is that of a turning point, whose
/// time does not matter. The largest of several is followed.
struct CostSlopes {
  PerFigure<FigureSlope> of;             ///< of those that are the slope of one in figure_table
  PerFigure<std::string_view> why_none;  ///< why this closing has none; empty where it has
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

/// None where the cost is infinite, or about a figure that has no slope.
[[nodiscard]] std::optional<FigureSlope> cost_slope(const Aim& aim, const Metrics& figures, const CostScale& scale,
                                                    const MetricsOptions& options, const CostSlopes& slopes);

}  // namespace softland
