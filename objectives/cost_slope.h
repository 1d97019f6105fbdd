// The derivative of a closing's cost: the sum of the derivatives of the figures of merit in the cost, each weighted with the
// derivative of the cost by this figure.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "model/linearized_closing.h"
#include "objectives/cost.h"
#include "objectives/figure_values.h"

namespace softland {

/// A crossing of the contact plane is called grazing, and reported with the derivatives, when its speed is below this share of
/// the speed of the first touch: the derivatives then hold in a small neighbourhood only.
inline constexpr double grazing_share = 0.1;

/// Derivatives of the figures that enter the cost of a closing. A figure taken where the contact point crosses the contact
/// plane also changes because the time of the crossing shifts; a height or depth at a turning point does not. Of several
/// heights or depths in a closing, only the largest counts.
struct CostSlopes {
  PerFigure<FigureSlope> of;             ///< derivatives of the figures of merit named in Figure::slope
  PerFigure<std::string_view> why_none;  ///< reason why a figure has no derivative for this closing; empty when it has one
  /// True when a rebound has not ended at the end of the run. The derivatives of last_rebound_end and separated leave this
  /// rebound out.
  bool ends_above = false;
  /// Speed of the slowest crossing of the contact plane over the speed of the first touch; 1 for a single touch. When this
  /// ratio is small, a touch is about to begin or to vanish, and derivatives hold in a small neighbourhood only.
  double grazing = 1;
};
/// Returns the derivatives of the figures of a closing, as weights of the derivative of its motion by a parameter. The drive
/// energy has no derivative here.
[[nodiscard]] CostSlopes cost_slopes(const Switch& model, std::span<const Signal> signals, const LinearizedClosing& motion,
                                     const MetricsOptions& options);

/// Returns the derivative of the cost of a closing; none when the cost is infinite, or depends on a figure that has no
/// derivative.
[[nodiscard]] std::optional<FigureSlope> cost_slope(const Aim& aim, const Metrics& figures, const CostScale& scale,
                                                    const MetricsOptions& options, const CostSlopes& slopes);

}  // namespace softland
