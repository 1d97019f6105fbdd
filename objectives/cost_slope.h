// The derivative of a closing's cost: the sum, weighted as in the cost, of the contribution of each figure behind the cost to
// the derivative of the motion.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "model/linearized_closing.h"
#include "objectives/cost.h"

namespace softland {

/// A crossing of the contact plane is grazing when its speed is below this share of the speed of the first touch.
inline constexpr double grazing_share = 0.1;

/// Derivatives of the figures behind the cost. The time of a crossing of the contact plane depends on the motion; a height or a
/// depth belongs to a turning point, whose time does not matter. When there are several heights or depths, only the largest
/// counts.
struct CostSlopes {
  PerFigure<FigureSlope> of;             ///< slopes of the figures that `Figure::slope` of a row of figure_table names
  PerFigure<std::string_view> why_none;  ///< reason why this closing has no slope of the figure; empty when it has one
  /// True when a rebound has not ended at the end of the run. The slopes of last_rebound_end and separated leave this rebound
  /// out.
  bool ends_above = false;
  /// Speed of the slowest crossing of the contact plane over that of the first touch; 1 for a single touch. When it is small, a
  /// touch is about to begin or to vanish, and derivatives hold in a small neighbourhood only.
  double grazing = 1;
};
/// Returns the slopes of the closing with these figures and this motion. The drive energy has no slope here.
[[nodiscard]] CostSlopes cost_slopes(const Switch& model, std::span<const Signal> signals, const LinearizedClosing& motion,
                                     const MetricsOptions& options);

/// Returns the derivative of the cost; none when the cost is infinite, or depends on a figure that has no slope.
[[nodiscard]] std::optional<FigureSlope> cost_slope(const Aim& aim, const Metrics& figures, const CostScale& scale,
                                                    const MetricsOptions& options, const CostSlopes& slopes);

}  // namespace softland
