// Time integration of one closing: from rest under the drives' values before t = 0, through every waveform breakpoint and every
// make and break of contact. An opening is integrated in the same way, from rest on the contact.
//
// The integrator restarts at waveform breakpoints and at make and break of contact. It also restarts where a contact law is not
// smooth and where a law with memory changes from one of its curves to another, as at a turning point while loading. So it only
// ever integrates smooth right-hand sides. At a rigid contact the velocity is reversed, or the plate rests and nothing is
// integrated until the drives pull the plate off.
//
// Within a step the motion of the contact point is interpolated: the free vibration of the modes plus a quintic polynomial
// (integrators/modal_motion.h). Contact events are the zeros between the extrema of this interpolant, searched in pieces of the
// step, each a fraction of a radian of the fastest mode (so no grazing touch is missed). A step with an event is repeated so
// that it ends at the event. The trajectory has a knot (point of the simulated motion) at the end of every piece.
//
// Error weights: a mode's coordinate counts by the deflection that it causes at the contact point, its velocity by this
// deflection times the frequency of the mode. In flight the tolerance is relative to the contact gap, in contact to the
// penetration, which is a thousand times smaller.
//
// An `automatic` run changes to BDF, with a hundredth of the tolerance, when stability of the explicit method, and not the
// tolerance, limits the length of a thousand steps and more. This happens in a thick film in a gap that is nearly closed.
//
// Every run audits its energy (closing/energy_audit.h). Dissipation is integrated by Simpson's rule over each step, and more
// exactly once the residual exceeds 1e-4 of the energy that bends the beam by the contact gap. An integrator that loses the
// contact between two steps, or a tolerance too loose for a stiff contact, shows as energy that no source supplied. A residual
// above 1 % of that bending energy is a warning; above 20 % the run is a numerical failure.
//
// A compressible gas film adds its pressures to the states; they diffuse within thousandths of a period. Such scenes run
// implicitly, with an equation solver that exploits that the film pressures at two positions along the beam couple only
// through the beam.
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

/// The equilibrium in which a run begins, under the drives' voltages before t = 0.
enum class StartState { open, closed };

/// Returns the integrator with which a run begins if the user chooses none: lawson (explicit), or esdirk (implicit) for a
/// compressible gas film.
[[nodiscard]] Integrator automatic_integrator(const Switch& model);

struct ClosingOptions {
  double duration = 0;      ///< length of the simulated time window [s]
  double tolerance = 1e-6;  ///< relative tolerance of the integrator
  Integrator integrator = Integrator::automatic;
  double after_contact = std::numeric_limits<double>::infinity();  ///< time from the first touch to the end of the run [s]
  double no_end_before = 0;  ///< earliest end of a run with a touch, even when the time after_contact has passed [s]
  /// Time at which a run ends if the switch has not touched by then [s].
  double no_contact_before = std::numeric_limits<double>::infinity();
  long max_steps = 2'000'000;  ///< largest number of integration steps: a run that needs more ends as numerical_failure
  /// If false, the integrator does not stop at make and break of contact: the contact force begins within a step, and the times
  /// of make and break are as exact as the interpolation in the step. The tolerance of motion in contact applies to the whole
  /// run. Studies set false to measure the effect of the stops; see why_always_restarted().
  bool restart_at_contact = true;
  /// Potential of the closed equilibrium under the hold levels [J]; if given, Trajectory::landing_excess is computed relative
  /// to this potential.
  double closed_potential = std::numeric_limits<double>::quiet_NaN();
  /// Contact force above which the force counts as steady [N]; if given, ForceOutcome::steady_force_time is computed.
  double steady_force = std::numeric_limits<double>::quiet_NaN();
  /// Modal coordinates [m kg^(1/2)] of a closed equilibrium under the drives' voltages before t = 0; if given, the run begins
  /// in this equilibrium. The contact at the start counts as a touch that began at t = 0 with impact velocity 0.
  std::span<const double> begins_closed = {};
  /// Equilibrium at the start of the run when begins_closed is empty: `closed` is the stable closed equilibrium under the
  /// drives' voltages before t = 0.
  StartState start = StartState::open;
  /// Time at which the drives command a closed switch to open [s]. Figures of the closing, such as
  /// ForceOutcome::steady_force_time and the electrical state, describe the motion before opens_at.
  double opens_at = std::numeric_limits<double>::infinity();
  const std::atomic<bool>* stop = nullptr;  ///< set by another thread; ends the run as `interrupted`
  /// Called after every step with time [s], modal coordinates q and velocities v; the states of a compressible film follow v in
  /// memory. The run ends with status done when the function returns true.
  std::function<bool(double, const double*, const double*)> observer = {};
};

/// Returns the reason why a closing of this switch cannot be run with restart_at_contact = false; empty when it can.
[[nodiscard]] std::string why_always_restarted(const Switch& model);

/// Simulates a closing. A numerical failure is never an exception: see Trajectory::status, which is collapsed_at_rest when the
/// equilibrium that `start` requires does not exist. Throws InvalidInput unless there is one signal per drive of the switch,
/// duration and tolerance are positive and tolerance <= 0.1. Throws InvalidInput also when begins_closed has a wrong number of
/// coordinates, when a run should begin closed and the switch has no contact, and when restart_at_contact is false although
/// why_always_restarted() gives a reason.
[[nodiscard]] Trajectory simulate_closing(const Switch& model, std::span<const Signal> drives, const ClosingOptions& options);

/// Returns the time at which the contact closes first, or the connection of several contacts [s]; NaN if it does not close. The
/// run ends then: options.after_contact and options.observer are ignored.
[[nodiscard]] double first_closing(const Switch& model, std::span<const Signal> drives, ClosingOptions options);

/// Simulates a closing and passes motion and touches to an observer; the returned trajectory has neither.
[[nodiscard]] Trajectory observe_closing(const Switch& model, std::span<const Signal> drives, const ClosingOptions& options,
                                         ClosingObserver& observer);

}  // namespace softland
