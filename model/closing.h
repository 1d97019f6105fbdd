// Time integration of one closing: from rest under the drives' values before t = 0, through every waveform breakpoint and every
// make and break of contact. An opening is integrated in the same way, from rest on the contact.
//
// The integrator restarts at waveform breakpoints and at make and break of contact. It also restarts where a contact law is not
// smooth or, with memory, passes from one of its curves to another (turning points while loading among them). So it only ever
// integrates smooth right-hand sides. At a rigid contact the velocity is reversed, or the plate rests and nothing is integrated
// until it is pulled off.
//
// Within a step the contact point moves as the free modes do, plus a quintic (integrators/modal_motion.h). Contact events are
// the zeros between the extrema of that motion, searched in pieces of a fraction of a radian of the fastest mode (grazing
// touches do not hide between steps). A step with an event is repeated until it ends there. The trajectory has a knot at the
// end of every piece.
//
// Error weights: a mode's coordinate counts as the deflection it causes at the contact point, its velocity as that times its
// frequency. In flight the tolerance is relative to the contact gap, in contact to the penetration, which is a thousand times
// smaller.
//
// An `automatic` run changes to BDF, with a hundredth of the tolerance, when a thousand and more steps are short for the
// stability of the explicit method and not for the tolerance. This happens in a thick film in a gap that is nearly closed.
//
// Every run audits its energy (closing/energy_audit.h). Dissipation is integrated by Simpson's rule over each step, and more
// exactly once the residual exceeds 1e-4 of the energy that bends the beam by the contact gap. An integrator that loses the
// contact between two steps, or a tolerance too loose for a stiff one, shows as energy that no source supplied. A residual
// above 1 % of that bending energy is a warning; above 20 % the run is a numerical failure.
//
// A compressible gas film adds its pressures to the states; their diffusion takes thousandths of a period. Such
// scenes run implicitly, with an equation solver that uses that the stations of the film couple only through the beam.
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

/// The equilibrium in which a run begins, under the drives' values before t = 0.
enum class StartState { open, closed };

/// Returns the integrator with which `automatic` begins: lawson, or esdirk where a gas film is compressible.
[[nodiscard]] Integrator automatic_integrator(const Switch& model);

struct ClosingOptions {
  double duration = 0;      ///< window [s]
  double tolerance = 1e-6;  ///< relative tolerance of the integrator
  Integrator integrator = Integrator::automatic;
  double after_contact = std::numeric_limits<double>::infinity();  ///< time from the first touch to the end of the run [s]
  double no_end_before = 0;  ///< earliest end of a run that has touched, whatever after_contact is [s]
  double no_contact_before = std::numeric_limits<double>::infinity();  ///< time at which a run without touch ends [s]
  long max_steps = 2'000'000;  ///< largest number of steps: a run that needs more ends as numerical_failure
  /// False: the contact is a force that sets in within a step, as for an integrator without events. Steps continue through make
  /// and break, which are then as exact as the interpolant; tolerances are those of contact throughout. Studies use it to
  /// measure the value of restarting: see why_always_restarted().
  bool restart_at_contact = true;
  /// Potential of the closed equilibrium under the hold levels [J]; if given, Trajectory::landing_excess is measured against
  /// it.
  double closed_potential = std::numeric_limits<double>::quiet_NaN();
  /// Contact force that counts as steady [N]; if given, Trajectory::steady_force_time is measured.
  double steady_force = std::numeric_limits<double>::quiet_NaN();
  /// Modal coordinates [m kg^(1/2)] of a closed equilibrium under the drives' values before t = 0; if given, the run begins
  /// there, at rest on the contact. The touch that holds then counts as one that began at t = 0 at no speed.
  std::span<const double> begins_closed = {};
  /// Equilibrium at the start where begins_closed is empty: `closed` is the stable closed one under the drives' values before t
  /// = 0.
  StartState start = StartState::open;
  /// Time at which the drives command a closed switch to open [s]. The contact force and the electrical state after it are not
  /// those of the closing: Trajectory::steady_force_time and the like describe the time before.
  double opens_at = std::numeric_limits<double>::infinity();
  const std::atomic<bool>* stop = nullptr;  ///< set from outside; ends the run as `interrupted`
  /// Called after every step with time [s], q and v, which the states of a compressible film follow; returns true to end the
  /// run (status done).
  std::function<bool(double, const double*, const double*)> observer = {};
};

/// Returns the reason why a closing of this switch cannot be run with restart_at_contact = false; empty when it can.
[[nodiscard]] std::string why_always_restarted(const Switch& model);

/// Never throws for numerical trouble: see Trajectory::status, which is collapsed_at_rest where the equilibrium that `start`
/// requires does not exist. Throws InvalidInput unless there is one signal per drive of the switch, duration and tolerance are
/// positive and tolerance <= 0.1. Throws it also where begins_closed has a wrong number of coordinates; where a run should
/// begin closed and the switch has no contact; or where restart_at_contact is false and cannot be.
[[nodiscard]] Trajectory simulate_closing(const Switch& model, std::span<const Signal> drives, const ClosingOptions& options);

/// Runs the same for an observer, which alone receives points and touches: those of the result stay empty.
[[nodiscard]] Trajectory observe_closing(const Switch& model, std::span<const Signal> drives, const ClosingOptions& options,
                                         ClosingObserver& observer);

}  // namespace softland
