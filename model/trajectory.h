// A closing as the figures of merit see it: what the contact point did.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "integrators/integrator.h"
#include "model/status.h"

namespace softland {

/// One knot. Between knots position is the quintic Hermite interpolant of (position, velocity, acceleration), so knots must not
/// straddle a kink: every make and break of contact and every waveform breakpoint is a knot. Two knots of equal time are a jump
/// of velocity or acceleration.
struct TrajectoryPoint {
  double time = 0;           ///< [s]
  double position = 0;       ///< of the contact point, from rest towards the contact [m]
  double velocity = 0;       ///< [m/s]
  double acceleration = 0;   ///< [m/s^2]
  double contact_force = 0;  ///< [N], positive pushes the beam away from the contact
};

/// One interval in which the contact law is active; an instant for an impact on a rigid contact from which the plate rebounds.
struct Touch {
  double begin = 0;            ///< [s]
  double end = 0;              ///< [s]; NaN when contact still holds at the end of the window
  double impact_velocity = 0;  ///< [m/s] at begin
  double peak_force = 0;       ///< [N]; NaN for a rigid contact, which has an impulse instead
  double peak_energy = 0;      ///< largest energy stored in the contact law, of a rigid one the kinetic energy at impact [J]
  /// Largest pressure of the highest summit over the hardness (model/contact/summit_pressure.h); NaN where it is not known.
  double pressure = std::numeric_limits<double>::quiet_NaN();
};

struct Work {
  Integrator integrator = Integrator::automatic;  ///< that ended the run
  long steps = 0;
  long rhs_evaluations = 0;
  double wall = 0;  ///< [s]
};

/// Energy balance of a run up to some time: work of the sources = change of stored energy + dissipated energy.
struct EnergyBalance {
  double source_work = std::numeric_limits<double>::quiet_NaN();  ///< integral of V dQ over all drives [J]
  double stored = 0;      ///< change of kinetic + elastic + electrostatic + contact energy [J]
  double dissipated = 0;  ///< gas, modal damping, contact [J]
  [[nodiscard]] double residual() const { return source_work - stored - dissipated; }
};

/// When a connection was electrically closed in a run: see model/closing/electrical_record.h.
struct ElectricalOutcome {
  double first_closed = std::numeric_limits<double>::quiet_NaN();  ///< [s]; NaN where it never is
  double closed_from =
      std::numeric_limits<double>::quiet_NaN();  ///< from when on it stays so [s]; NaN where it is open at the end
  int openings = 0;                              ///< after first_closed, those that count
};

/// One contact of several, at the end of a run.
struct ContactOutcome {
  std::string name;
  std::vector<TrajectoryPoint> points;  ///< what its place did
  std::vector<Touch> touches;
  double gap = 0;                                                             ///< rest distance to its plane [m]
  double deepest_penetration = 0;                                             ///< [m]
  double hold_force = std::numeric_limits<double>::quiet_NaN();               ///< as Trajectory::hold_force [N]
  double steady_force_time = std::numeric_limits<double>::quiet_NaN();        ///< [s]
  double least_force_after_touch = std::numeric_limits<double>::quiet_NaN();  ///< [N]
  double hold_resistance = std::numeric_limits<double>::quiet_NaN();          ///< as Trajectory::hold_resistance [Ohm]
  ElectricalOutcome electrical = {};
};

/// Of a switch with several contacts the members are those of the connection that they make (model/closing/connection.h).
struct Trajectory {
  Status status = Status::not_run;
  std::string message;  ///< why, where it is not done
  /// The run began in contact (ClosingOptions::start, begins_closed): its first touch is none that the drives have made.
  bool began_closed = false;
  /// Contact point in the equilibrium of the other StartState, where the one that was asked for does not exist [m].
  double other_start = std::numeric_limits<double>::quiet_NaN();
  bool ends_at_touch = false;  ///< the switch has no contact, so the run ended where it first reached the plane
  double contact_gap = 0;      ///< dt: the first-touch plane [m]
  std::vector<TrajectoryPoint> points;
  std::vector<Touch> touches;
  double in_contact_period =
      std::numeric_limits<double>::quiet_NaN();  ///< 2 pi over the first frequency of the beam pinned at x_c [s]
  double hold_force =
      std::numeric_limits<double>::quiet_NaN();  ///< of the closed equilibrium under the hold levels, if computed [N]
  /// Of the connection, where the switch rests closed under the hold levels [Ohm]; NaN where that is open, or not known.
  double hold_resistance = std::numeric_limits<double>::quiet_NaN();
  /// Between the electrode that closes the switch and the beam, where the hold levels leave it [F]: closed, or where nothing
  /// touched, open.
  double hold_capacitance = std::numeric_limits<double>::quiet_NaN();
  bool is_held = true;  ///< false where the switch is known to have no stable closed equilibrium under the hold levels
  double collapse_time = std::numeric_limits<double>::quiet_NaN();  ///< at which the beam met the electrode [s]
  double smallest_gap = std::numeric_limits<double>::quiet_NaN();   ///< beam to electrode, anywhere, ever [m]
  /// Energy above that of the closed equilibrium once the switch has touched and the drives stand at their hold levels [J]: what
  /// has to be dissipated, by bouncing or otherwise, before the switch rests; what impacts on a rigid contact have taken by then
  /// is part of it.
  double landing_excess = std::numeric_limits<double>::quiet_NaN();
  double deepest_penetration = 0;  ///< [m]
  /// From when on, to the end of the run, the contact force is not below ClosingOptions::steady_force [s]; NaN where it is at
  /// the end, where nothing touched, and where none was asked for.
  double steady_force_time = std::numeric_limits<double>::quiet_NaN();
  /// Of the contact, from its first maximum after the first touch to the end of the run; at the end where it only rises [N].
  /// NaN where nothing touched.
  double least_force_after_touch = std::numeric_limits<double>::quiet_NaN();
  /// Of several contacts each; empty where there is one.
  std::vector<ContactOutcome> contacts;
  /// Where there are several: first touch of any that makes the connection [s], and the speed there [m/s]. NaN where there is
  /// one, or nothing touched.
  double first_touch = std::numeric_limits<double>::quiet_NaN();
  double first_touch_velocity = std::numeric_limits<double>::quiet_NaN();
  /// Where Device::electrical asks for it.
  ElectricalOutcome electrical = {};
  EnergyBalance energy;     ///< at the end
  double layer_energy = 0;  ///< layer_charging_energy() of the piezo, which no balance holds [J]
  /// Largest residual of the energy balance at any make or break of contact and at the end [J].
  double energy_error = 0;
  Work work;
  std::vector<std::string> warnings;
};

}  // namespace softland
