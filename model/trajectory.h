// The result of a closing: the motion of the contact point, touches, and further numbers for figures of merit.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "integrators/integrator.h"
#include "model/status.h"

namespace softland {

/// A knot: one point of the simulated motion of the contact point. Between knots the position is the quintic Hermite
/// interpolant of (position, velocity, acceleration), so knots must not straddle a kink: every make and break of contact and
/// every waveform breakpoint is a knot. Two knots of equal time are a jump of velocity or acceleration.
struct TrajectoryPoint {
  double time = 0;           ///< time of this point of the motion [s]
  double position = 0;       ///< position of the contact point, from rest towards the contact [m]
  double velocity = 0;       ///< velocity of the contact point [m/s]
  double acceleration = 0;   ///< acceleration of the contact point [m/s^2]
  double contact_force = 0;  ///< contact force, positive when it pushes the beam away from the contact [N]
};

/// A touch: one time interval in which the contact law acts. The interval is an instant for an impact on a rigid contact from
/// which the plate rebounds.
struct Touch {
  double begin = 0;            ///< time at which contact begins [s]
  double end = 0;              ///< time at which contact ends [s]; NaN when the contact is closed at the end of the run
  double impact_velocity = 0;  ///< velocity of the contact point when contact begins [m/s]
  double peak_force = 0;       ///< largest contact force [N]; NaN for a rigid contact, which has an impulse instead
  double peak_energy = 0;      ///< largest energy stored in the contact; for a rigid contact kinetic energy at impact [J]
  /// Largest pressure of the highest asperity summit over its hardness (model/contact/summit_pressure.h); NaN unless both are
  /// known.
  double pressure = std::numeric_limits<double>::quiet_NaN();

  /// Adds another touch, of this or another contact: its energy, and its velocity, force and pressure where they are larger.
  void add(const Touch& other) {
    impact_velocity = std::fmax(impact_velocity, other.impact_velocity);
    // The largest force is NaN when that of one touch is NaN, for a rigid contact.
    if (std::isnan(other.peak_force) || other.peak_force > peak_force) peak_force = other.peak_force;
    peak_energy += other.peak_energy;
    pressure = std::fmax(pressure, other.pressure);
  }
};

/// The first touch of a contact, or of any contact that makes an electrical connection.
struct FirstTouch {
  double time = std::numeric_limits<double>::quiet_NaN();      ///< time of the first touch [s]; NaN before a touch
  double velocity = std::numeric_limits<double>::quiet_NaN();  ///< impact velocity of the first touch [m/s]; NaN before a touch

  [[nodiscard]] bool happened() const { return !std::isnan(time); }
  /// Stores a touch at a time [s] with an impact velocity [m/s] if it is earlier than the stored touch.
  void take(double at, double impact_velocity) {
    if (!(time <= at)) *this = {.time = at, .velocity = impact_velocity};
  }
};

struct Work {
  Integrator integrator = Integrator::automatic;  ///< integration method in use at the end of the run
  long steps = 0;
  long rhs_evaluations = 0;
  double wall = 0;  ///< wall-clock time of the run [s]
};

/// Energy balance of a run up to some time: work of the sources = change of stored energy + dissipated energy.
struct EnergyBalance {
  double source_work = std::numeric_limits<double>::quiet_NaN();  ///< work of the sources, integral of V dQ over all drives [J]
  double stored = 0;      ///< change of kinetic + elastic + electrostatic + contact energy [J]
  double dissipated = 0;  ///< energy dissipated by gas, modal damping, contact [J]
  [[nodiscard]] double residual() const { return source_work - stored - dissipated; }
};

/// The times at which the electrical connection through the contacts was closed in a run: see
/// model/closing/electrical_record.h.
struct ElectricalOutcome {
  /// Time at which the connection first closes [s]; NaN when it never closes.
  double first_closed = std::numeric_limits<double>::quiet_NaN();
  /// Time from which the electrical connection stays closed [s], until the end of the run or the command to open; NaN when the
  /// connection is open then.
  double closed_from = std::numeric_limits<double>::quiet_NaN();
  int openings = 0;  ///< number of electrical openings after first_closed that are longer than ElectricalClosing::after
};

/// Figures of merit of the contact force after first contact. ForceRecord computes them, and force_of_connection() combines
/// those of several contacts.
struct ForceOutcome {
  /// Time from which the contact force stays at or above ClosingOptions::steady_force until the end of the run [s]. NaN when
  /// the force is below steady_force at the end, without a touch, and when no steady force was given.
  double steady_force_time = std::numeric_limits<double>::quiet_NaN();
  /// Least contact force from its first maximum after the first touch to the end of the run; the force at the end when the
  /// force only rises [N]. NaN without a touch.
  double least_force_after_touch = std::numeric_limits<double>::quiet_NaN();
};

/// The outcome of one contact of several, at the end of a run.
struct ContactOutcome {
  std::string name;
  std::vector<TrajectoryPoint> points;  ///< motion of the beam at the contact
  std::vector<Touch> touches;
  double gap = 0;                  ///< distance of the contact point from its contact plane at rest [m]
  double deepest_penetration = 0;  ///< largest penetration: motion of the contact point beyond the contact plane [m]
  /// Contact force in the closed equilibrium under the hold levels of the drives [N].
  double hold_force = std::numeric_limits<double>::quiet_NaN();
  ForceOutcome force = {};
  /// Contact resistance at rest under the hold levels of the drives [Ohm].
  double hold_resistance = std::numeric_limits<double>::quiet_NaN();
  ElectricalOutcome electrical = {};
};

/// The result of a simulated closing or opening. The members describe the connection that the contacts make
/// (model/closing/connection.h) when a switch has several contacts.
struct Trajectory {
  Status status = Status::not_run;
  std::string message;  ///< reason for the status, unless it is `done`
  /// True when the run began in contact (ClosingOptions::start, begins_closed), so that the drives did not cause the first
  /// touch.
  bool began_closed = false;
  /// When the equilibrium in which the run should begin does not exist: position of the contact point in the other equilibrium
  /// (closed if open was requested, and vice versa) if that exists [m].
  double other_start = std::numeric_limits<double>::quiet_NaN();
  bool ends_at_touch = false;  ///< true when the run ended at its first touch because the switch has no contact law
  double contact_gap = 0;      ///< distance of the contact point from the plane of first touch at rest [m]
  std::vector<TrajectoryPoint> points;
  std::vector<Touch> touches;
  /// Period of the lowest mode of the beam held at deflection 0 at its contact point [s].
  double in_contact_period = std::numeric_limits<double>::quiet_NaN();
  /// Contact force of the closed equilibrium under the hold levels of the drives, if computed [N].
  double hold_force = std::numeric_limits<double>::quiet_NaN();
  /// Resistance of the connection when the switch rests closed under the hold levels of the drives [Ohm]; NaN when the switch
  /// rests open, or a contact of the connection has no given resistivity.
  double hold_resistance = std::numeric_limits<double>::quiet_NaN();
  /// Capacitance between the beam and the electrode that closes the switch, at rest under the hold levels of the drives [F]: in
  /// the closed equilibrium, or in the open equilibrium after a run without a touch.
  double hold_capacitance = std::numeric_limits<double>::quiet_NaN();
  bool is_held = true;  ///< false when no stable closed equilibrium was found under the hold levels of the drives
  double collapse_time = std::numeric_limits<double>::quiet_NaN();  ///< time at which the beam reached the electrode [s]
  /// Smallest gap between beam and electrode, over the whole beam and the whole run [m].
  double smallest_gap = std::numeric_limits<double>::quiet_NaN();
  /// Energy above that of the closed equilibrium once the switch has touched and the drives are at their hold levels [J].
  /// Bouncing or damping must dissipate this energy before the switch rests. The value includes the energy that impacts
  /// on a rigid contact have dissipated until then.
  double landing_excess = std::numeric_limits<double>::quiet_NaN();
  double deepest_penetration = 0;  ///< largest penetration of the contact [m]
  ForceOutcome force = {};
  /// Outcomes of all contacts of a switch with several contacts; empty for a single contact.
  std::vector<ContactOutcome> contacts;
  /// First touch of any of several contacts that makes the connection; unset for a single contact.
  FirstTouch first_touch = {};
  /// Times of electrical closing of the connection, if Device::electrical gives a bound.
  ElectricalOutcome electrical = {};
  EnergyBalance energy;     ///< energy balance at the end of the run
  double layer_energy = 0;  ///< energy that charging the piezo layer takes, which is not part of the energy balance [J]
  /// Largest residual of the energy balance (source work less stored and dissipated energy), by magnitude, at any make or break
  /// of contact and at the end [J].
  double energy_error = 0;
  Work work;
  std::vector<std::string> warnings;
};

}  // namespace softland
