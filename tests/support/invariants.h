// Invariants of every run, however hard the case: checked from outside, with an energy balance of its own.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "model/closing.h"
#include "objectives/metrics.h"

namespace softland::test {

struct CheckedRun {
  Trajectory trajectory;
  Metrics metrics;
  double surplus = 0;  ///< largest energy that no source supplied, over the energy that bends the beam by the contact gap
  double largest_penetration = 0;  ///< bound of it: where first loading alone takes up the energy there was and a twentieth [m]
  std::vector<std::string> violations;
};

/// Runs a closing and looks for violations of:
/// - no energy without a source: after every step kinetic energy and potential are at most those at rest and what changing
///   drives have added, to `energy` times the energy that bends the beam by the contact gap or that the drives have moved (where
///   the run says done);
/// - no falling through: the deepest interference is one at which the contact law has taken up no more than the energy there
///   was, with what the drives added in contact, and a twentieth (of a contact along the pad, whose tilt also counts, the energy
///   above is all that is checked);
/// - no event missed: in flight the motion between two knots is nowhere beyond the contact plane, in contact nowhere before it;
///   touches are in order; there are no more rebounds than touches;
/// - no number that is not one: knots, touches and every figure that the status promises;
/// - bounded work: no more steps than allowed, no more evaluations than the steps explain;
/// - a run that is not done says where and why.
/// The observer of the options must be free.
[[nodiscard]] CheckedRun checked_run(const Switch& model, std::span<const Signal> drives, const ClosingOptions& options,
                                     double energy = 1e-3, const MetricsOptions& metrics = {});

/// The well-conditioned figures of a closing: its landing and its first rebound higher than a hundredth of the contact gap, 0
/// without such a rebound.
struct Landing {
  double time = 0;      ///< t_i [s]
  double velocity = 0;  ///< v_i [m/s]
  double rebound = 0;   ///< [m]
};
[[nodiscard]] Landing landing(const Trajectory& trajectory);

/// Describes an event that a run of a closing or a tighter run has missed; empty where they agree. The runs are compared touch
/// by touch, lengths over the contact gap and velocities over the contact point's largest. A touch of speed u makes of a
/// difference e one of about e / u. One run alone may have a touch gentler than the root of e. The difference thus grows from
/// touch to touch to ten times its root at the most, while a missed touch differs by u at once. Differences of the ends of
/// touches count as well: a contact with memory rattles in its dent. The comparison ends at a difference of 1e-4. A closing has
/// magnified it by a thousand and more by then, the rattle of a soft landing too, which says nothing of its events.
[[nodiscard]] std::string missed_touch(const Trajectory& run, const Trajectory& tighter);

}  // namespace softland::test
