// What every run must keep, however hard the case: checked from outside, with an energy balance of its own.
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
/// where there is none.
struct Landing {
  double time = 0;      ///< t_i [s]
  double velocity = 0;  ///< v_i [m/s]
  double rebound = 0;   ///< [m]
};
[[nodiscard]] Landing landing(const Trajectory& trajectory);

/// What a run of a closing and a tighter one say of an event that one of them has missed; empty where they agree. They are
/// followed touch by touch. Lengths over the contact gap and velocities over the contact point's largest, a touch of speed u
/// makes of a difference e one of about e / u, and one gentler than the root of e may be had by one run alone: so from touch to
/// touch the difference grows to ten times its root at the most, while a touch that is missed differs by u at once. What the ends
/// of touches differ by counts as well: in its dent a contact with memory rattles. Follows them until they differ by 1e-4: what a
/// closing has magnified by a thousand and more, the rattle of a soft landing too, says nothing of its events.
[[nodiscard]] std::string missed_touch(const Trajectory& run, const Trajectory& tighter);

}  // namespace softland::test
