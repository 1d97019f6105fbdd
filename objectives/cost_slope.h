// The derivative of a closing's cost: the sum, weighted as in the cost, of the contribution of each figure behind the cost to
// the derivative of the motion.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "model/linearized_closing.h"
#include "objectives/cost.h"

namespace softland {

/// A crossing of the plane that is slower than this share of the speed of the first touch grazes.
inline constexpr double grazing_share = 0.1;

/// A crossing of the plane happens at a time that moves with the motion; a height or a depth is that of a turning point, whose
/// time does not matter. The largest of several is followed.
struct CostSlopes {
  PerFigure<FigureSlope> of;             ///< slopes of the figures that are the slope of one in figure_table
  PerFigure<std::string_view> why_none;  ///< reason why this closing has no slope of the figure; empty where it has one
  /// True while a rebound is under way at the end of the run. No derivative accounts for it: last_rebound_end and separated
  /// leave it out.
  bool ends_above = false;
  /// Slowest crossing of the plane over the speed of the first touch; 1 where there is one touch. Where it is small, a touch is
  /// about to begin or to vanish, and derivatives hold in a small neighbourhood only.
  double grazing = 1;
};
/// Returns the slopes of the closing with these figures and this motion. The drive energy has no slope here.
[[nodiscard]] CostSlopes cost_slopes(const Switch& model, std::span<const Signal> signals, const LinearizedClosing& motion,
                                     const MetricsOptions& options);

/// Returns nothing where the cost is infinite, or depends on a figure that has no slope.
[[nodiscard]] std::optional<FigureSlope> cost_slope(const Aim& aim, const Metrics& figures, const CostScale& scale,
                                                    const MetricsOptions& options, const CostSlopes& slopes);

}  // namespace softland
