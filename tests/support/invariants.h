// Invariants of every run, also of hard cases. They are checked from the results alone, with an independent energy balance.
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
  double surplus = 0;  ///< largest energy without a source, over the energy that bends the beam by the contact gap
  /// Bound of the penetration: loading the contact up to it takes 1.05 times the available energy [m].
  double largest_penetration = 0;
  std::vector<std::string> violations;
};

/// Runs a closing and checks these invariants:
/// - No energy without a source. After every step the kinetic and potential energy are at most that at rest plus the work of
///   the changing drives. The tolerance is `energy` times the energy that bends the beam by the contact gap, or times the work
///   of the drives if the run is done.
/// - No penetration beyond the contact law. At the deepest interference the contact has taken up at most 1.05 times the energy
///   at touch plus the work of the drives in contact. For a contact along the pad only the energy is checked, since its tilt
///   also counts.
/// - No missed event. Between two knots in flight the motion stays before the contact plane, between two knots in contact
///   beyond it. Touches are in order, and there are no more rebounds than touches.
/// - Knots, touches and all figures that the status promises are finite numbers.
/// - Bounded work. The numbers of steps and evaluations are within their limits.
/// - A run that is not done has a message that says where and why.
/// The options must have no observer.
[[nodiscard]] CheckedRun checked_run(const Switch& model, std::span<const Signal> drives, const ClosingOptions& options,
                                     double energy = 1e-3, const MetricsOptions& metrics = {});

/// The well-conditioned figures of a closing: its landing, and its first rebound that is higher than a hundredth of the contact
/// gap (0 without one).
struct Landing {
  double time = 0;      ///< t_i [s]
  double velocity = 0;  ///< v_i [m/s]
  double rebound = 0;   ///< height of that rebound [m]
};
[[nodiscard]] Landing landing(const Trajectory& trajectory);

/// Describes an event that a run of a closing, or a tighter run, has missed; empty if both have the same events. The runs are
/// compared touch by touch, with lengths over the contact gap and velocities over the largest one of the contact point.
///
/// A touch of speed u increases a difference e to about e / u, and a touch that is gentler than the root of e may occur in one
/// run only. The difference thus grows from touch to touch to at most ten times its root, while a missed touch makes a
/// difference of u at once. Differences of the ends of touches are compared as well: a contact with memory rattles in its dent.
/// The comparison ends at a difference of 1e-4, since the closing, or the rattle of a soft landing, has magnified the
/// difference a thousandfold by then.
[[nodiscard]] std::string missed_touch(const Trajectory& run, const Trajectory& tighter);

}  // namespace softland::test
