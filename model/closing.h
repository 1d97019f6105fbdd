// Time integration of one closing: from rest under what the drives stand at before t = 0, through every waveform breakpoint and
// every make and break of contact. An opening is integrated in the same way, from rest on the contact.
//
// The integrator restarts at waveform breakpoints, at make and break of contact, and, where the contact law has memory, where it
// passes from one of its curves to another (turning points while loading among them) or is not smooth, so it only ever sees
// smooth right-hand sides. At a rigid contact the velocity is reversed, or the plate rests and nothing is integrated until it is
// pulled off. Within a step the contact point moves as the free modes do, plus a quintic (integrators/modal_motion.h); contact
// events are the zeros between the extrema of that motion, looked for in pieces of a fraction of a radian of the fastest mode
// (grazing touches do not hide between steps), and a step with an event is repeated until it ends there. The trajectory has a
// knot at the end of every piece. Error weights: a mode's coordinate counts as the deflection it causes at the contact point, its
// velocity as that times its frequency. In flight the tolerance is relative to the contact gap, in contact to the penetration,
// which is a thousand times smaller.
//
// Steps that are short for the stability of the explicit method and not for the tolerance, as in a thick film in a gap that is
// all but closed, a thousand of them and more, make an `automatic` run go over to BDF, with a hundredth of the tolerance.
//
// Every run audits its energy (closing/energy_audit.h), dissipation by Simpson's rule over each step, and more exactly from where
// the balance is off by 1e-4 of the energy that bends the beam by the contact gap: an integrator that loses the contact
// between two steps, or a tolerance too loose for a stiff one, shows as energy that no source supplied. A residual above 1 % of
// the energy that bends the beam by the contact gap is a warning, above 20 % the run is a numerical failure.
//
// A compressible gas film adds its pressures to the states, in thousandths of a period of diffusion: such scenes run implicitly,
// with an equation solver that knows that the stations of the film only meet in the beam.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "model/closing/observer.h"
#include "model/switch.h"
#include "model/trajectory.h"
#include "waveforms/signal.h"

namespace softland {

/// The equilibrium under what the drives stand at before t = 0 in which a run begins.
enum class StartState { open, closed };

/// What `automatic` begins with: lawson, or esdirk where a gas film is compressible.
[[nodiscard]] Integrator automatic_integrator(const Switch& model);

struct ClosingOptions {
  double duration = 0;      ///< window [s]
  double tolerance = 1e-6;  ///< relative, of the integrator
  Integrator integrator = Integrator::automatic;
  double after_contact = std::numeric_limits<double>::infinity();  ///< end this long after first touch [s]
  double no_end_before = 0;  ///< a run that has touched goes on until then, whatever after_contact is [s]
  double no_contact_before = std::numeric_limits<double>::infinity();  ///< end here if nothing has touched [s]
  long max_steps = 2'000'000;  ///< work bound: a run that needs more ends as numerical_failure
  /// False: the contact is a force that sets in within a step, as to an integrator that knows of no events. Steps go on through
  /// make and break, which are then as exact as the interpolant; tolerances are those of contact throughout. For studies of what
  /// restarting is worth: see why_always_restarted().
  bool restart_at_contact = true;
  /// Potential of the closed equilibrium under the hold levels [J]: when given, Trajectory::landing_excess is measured against
  /// it.
  double closed_potential = std::numeric_limits<double>::quiet_NaN();
  /// Contact force that counts as steady [N]: when given, Trajectory::steady_force_time is measured.
  double steady_force = std::numeric_limits<double>::quiet_NaN();
  /// Where given, the run begins at rest on the contact, with these modal coordinates [m kg^(1/2)]: those of a closed equilibrium
  /// under what the drives have been before t = 0. The touch that holds then counts as one that began at t = 0 at no speed.
  std::span<const double> begins_closed = {};
  /// Where begins_closed is empty: `closed` begins in the stable closed equilibrium under what the drives have been before t = 0.
  StartState start = StartState::open;
  /// The drives command a closed switch to open at this time [s]. The contact force and the electrical state after it are not
  /// those of the closing: Trajectory::steady_force_time and the like tell of the time before.
  double opens_at = std::numeric_limits<double>::infinity();
  const std::atomic<bool>* stop = nullptr;  ///< set from outside: ends the run as `interrupted`
  /// Called after every step with time [s], q and v, which the states of a compressible film follow; true ends the run (status
  /// done).
  std::function<bool(double, const double*, const double*)> observer = {};
};

/// Why a closing of this switch cannot be run with restart_at_contact = false; empty when it can.
[[nodiscard]] std::string why_always_restarted(const Switch& model);

/// Never throws for numerical trouble: see Trajectory::status, which is collapsed_at_rest where the equilibrium that `start` asks
/// for does not exist. Throws InvalidInput unless there is one signal per drive of the
/// switch, duration and tolerance are positive and tolerance <= 0.1; where begins_closed has a coordinate too many or too few, or
/// a run is to begin closed and the switch has no contact; or where restart_at_contact is false and cannot be.
[[nodiscard]] Trajectory simulate_closing(const Switch& model, std::span<const Signal> drives, const ClosingOptions& options);

/// The same for an observer, who alone receives points and touches: those of the result stay empty.
[[nodiscard]] Trajectory observe_closing(const Switch& model, std::span<const Signal> drives, const ClosingOptions& options,
                                         ClosingObserver& observer);

}  // namespace softland
