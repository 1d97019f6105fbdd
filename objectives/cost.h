// What a search minimises: a smooth stand-in for each target, made of the well-conditioned figures of a closing and normalised by
// the plain step to the same hold level, so that the step costs about 1.
//
// Bounce count and settling time jump at grazing rebounds and, past the first macro-bounce, are properties of a cloud of runs
// rather than of one: they are reported, never minimised. Every cost is scored over a fixed time after first contact, so that
// landing late gains nothing.
//
//   H  highest rebound, over that of the step           V  largest touch speed, over that of the step
//   K  energy above the closed equilibrium once the switch has touched and the drives stand at their hold levels, over that of
//   the
//      step: a squared velocity that also sees the vibration of the beam behind the contact point
//   S  time in separation after first touch, over the score window
//   P  h / (h + 10 h_s), h the highest rebound, h_s the significant height: the last nanometres, which H no longer sees
//   T  first touch, over that of the step               L  T + 10 max(0, T - T_free): lateness
//   R  end of the last rebound above the significant height (else first touch), over first touch of the step
//   N  sum over rebounds of h / (h + h_s), over that of the step        E  impact energy, over that of the step
//
//   bounce    0.2 H + 0.15 V^2 + 0.45 K + 0.1 S^2 + 0.05 P + 0.02 L
//   settling  0.4 R + 0.2 H + 0.1 V^2 + 0.25 K + 0.05 P
//   rebound   0.5 H + 0.1 V^2 + 0.33 K + 0.05 P + 0.02 L
//   count     0.3 N + 0.2 H + 0.1 V^2 + 0.33 K + 0.05 P + 0.02 L
//   impact    0.6 V + 0.1 H + 0.2 K + 0.05 P + 0.05 L
//   energy    0.5 E + 0.1 H + 0.1 V^2 + 0.2 K + 0.05 P + 0.05 L
//
// K leads: it is smooth where the rebounds are a chaotic sequence, and where it is small there are none. Squares make the sum
// flat and well-conditioned near a soft landing. Lateness costs little up to T_free and much beyond: the softest landing is a
// late one. A closing that never touches costs 10 plus the part of the gap it left, so that the search is led towards contact;
// one that fails (touches the electrode, leaves the laws' validity, cannot be integrated) is infeasible: infinity.
#pragma once

#include <optional>
#include <string_view>

#include "model/trajectory.h"
#include "objectives/metrics.h"

namespace softland {

enum class Target { bounce, settling, rebound, count, impact, energy };
[[nodiscard]] std::string_view to_string(Target target);
[[nodiscard]] std::optional<Target> target_from(std::string_view name);

/// The raw figures behind the costs, over a run that ends a fixed time after first contact.
struct CostFigures {
  bool touched = false;
  double closest = 0;           ///< smallest separation while nothing touched [m]
  double first_touch = 0;       ///< [s]
  double touch_speed = 0;       ///< largest over all touches [m/s]
  double rebound_height = 0;    ///< [m]
  double separated = 0;         ///< time above the first-touch plane after first touch [s]
  double last_rebound_end = 0;  ///< of those above the significant height; first_touch if none [s]
  double soft_count = 0;        ///< sum of h / (h + h_s)
  double impact_energy = 0;     ///< [J]
  double landing_excess = 0;    ///< [J]; 0 when it was not measured
};
[[nodiscard]] CostFigures cost_figures(const Trajectory& trajectory, const MetricsOptions& options);

struct CostScale {
  CostFigures step;         ///< figures of the plain step
  double score_window = 0;  ///< [s]
  double contact_gap = 0;   ///< [m]
  double free_touch = 0;    ///< T_free, over first touch of the step
};
[[nodiscard]] double cost(Target target, const Trajectory& trajectory, const CostScale& scale, const MetricsOptions& options);

}  // namespace softland
