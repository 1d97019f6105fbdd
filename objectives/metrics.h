// Figures of merit of a closing (names after Bognash 2019). Every figure is taken at the contact point. The table in
// objectives/figures.h has the names and units of figures in results.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "model/closing/observer.h"
#include "model/contact/summit_pressure.h"
#include "model/device.h"
#include "model/trajectory.h"
#include "objectives/opening.h"
#include "objectives/rebounds.h"
#include "objectives/transferred_charge.h"

namespace softland {

/// Optional figures of merit, which appear in results only for scenes that request them.
struct AskedFigures {
  bool resistance = false;  ///< true when the contacts that make the connection have a resistivity: show contact resistance
  bool electrical = false;  ///< true when the device requests figures of electrical closing (Device::electrical)
  bool opening = false;     ///< true when the run opens the switch on command: show figures of the opening
  bool pressure = false;    ///< true when a contact has asperity summits and a hardness: show the contact pressure
  bool charge = false;      ///< true when the device has a load circuit (Device::load): show the charge through the contact
  /// True when the device has a load circuit, and the run opens on command: show the charge on opening.
  bool break_charge = false;
  bool operator==(const AskedFigures&) const = default;
};
/// Returns the optional figures of merit that a device requests.
[[nodiscard]] inline AskedFigures asked_figures(const Device& device) {
  return {.resistance = device.conducts(),
          .electrical = device.electrical.is_asked(),
          .pressure =
              std::ranges::any_of(device.contacts, [](const Contact& c) { return c.connects && summit_pressure_scale(c) > 0; }),
          .charge = device.load.is_given()};
}

struct MetricsOptions {
  double significant_rebound = 1e-9;  ///< height above which a rebound counts [m]
  double steady_force = 0.1;          ///< share of the hold force above which the contact force counts as steady
  AskedFigures asked = {};
  OpeningCommand opening = {};    ///< command to open; figures of the closing describe the motion up to it
  TransferOptions transfer = {};  ///< load circuit for the transferred charge; set when Device::load is given
};

/// Figures of merit of a closing; those of the contact force are members of the base.
struct Metrics : ForceOutcome {
  static constexpr double unset = std::numeric_limits<double>::quiet_NaN();

  Status status = Status::not_run;
  double initial_contact_time = unset;    ///< t_i, time of first contact [s]
  double permanent_contact_time = unset;  ///< t_p, time from which the contact stays closed [s]; NaN when not settled
  double bounce_time = unset;             ///< t_b = t_p - t_i, duration of bouncing [s]
  int bounce_count = 0;                   ///< N_B, number of significant rebounds; meaningless without contact
  double major_bounce_height = unset;     ///< B_H, height of the highest rebound [m]; 0 when there is no rebound
  double first_rebound_time = unset;      ///< duration of the first significant rebound [s]; 0 without a rebound
  double impact_velocity = unset;         ///< v_i, impact velocity of the first touch [m/s]
  double peak_contact_force = unset;      ///< largest contact force of the run [N]
  double impact_energy = unset;           ///< sum over touches of the largest stored contact energy [J]
  double hold_force = unset;              ///< contact force in the closed equilibrium under the hold levels of the drives [N]
  double capacitance = unset;             ///< capacitance of beam and electrode at rest under the hold levels [F]
  double drive_energy = unset;            ///< energy that the drives give in the run [J]
  bool settled = false;
  double resistance = unset;           ///< contact resistance at rest under the hold levels [Ohm]
  double electrical_contact = unset;   ///< time at which the switch first closes electrically [s]
  double electrical_settling = unset;  ///< time from which the switch stays closed electrically [s]
  /// Number of electrical openings after the first closing; meaningless when the switch never closes electrically.
  int electrical_bounces = 0;
  double pressure = unset;  ///< largest pressure of an asperity summit in any touch, over the hardness of the contact
  /// Charge through the contact until the command to open, or the end of the run [C]; see objectives/transferred_charge.h.
  double make_charge = unset;
  double break_charge = unset;  ///< charge through the contact after the command to open [C]
  AskedFigures asked = {};      ///< optional figures of merit that results show
  // The figures from here to back_stop_velocity describe the opening; they are known when the drives command the switch to
  // open.
  double open_command = unset;  ///< time of the command to open [s]
  double opening_time = unset;  ///< time from the command to open to the last break of the contact [s]
  int release_bounces = 0;      ///< number of bounces on opening; meaningless if the run ends closed
  /// Highest separation after the command to open that ends in a touch [m]; 0 without a bounce.
  double release_bounce_height = unset;
  double release_settling_time = unset;  ///< time from the command to open to rest in the open state [s]
  /// Largest excursion of the contact point beyond its open position, away from the contact [m].
  double overshoot_open = unset;
  /// Smallest distance to the contact once the contact point has turned back towards it after the opening [m].
  double least_gap_open = unset;
  double closed_time = unset;  ///< time in contact from the first touch to the last break [s]
  /// Largest impact velocity on a back stop after the command to open, 0 without an impact [m/s]; set by simulate().
  double back_stop_velocity = unset;
  // simulate() sets static_deflection, overshoot and open_settling_time when the contact never closes.
  double static_deflection = unset;  ///< position of the contact point in the open equilibrium under the hold levels [m]
  /// Largest excursion of the contact point beyond static_deflection, away from its initial position [m].
  double overshoot = unset;
  /// Time from which the contact point stays within a band about static_deflection [s], see set_open_figures(); NaN when it
  /// does not settle.
  double open_settling_time = unset;
  // simulate() sets peak_voltage and peak_slew, figures of the drives in the simulated time window.
  /// Largest |V| of the electrodes' drives; that of the piezo's drive when there is no electrode [V].
  double peak_voltage = unset;
  double peak_slew = unset;                ///< largest |dV/dt| of any drive [V/s]; infinite for a jump of the voltage
  double largest_impact_velocity = unset;  ///< largest impact velocity of all touches [m/s]
  // The figures from here on enter the cost of a search; results do not show them.
  double closest = unset;    ///< smallest distance to the contact plane before the first touch [m]; known also without contact
  double separated = unset;  ///< total time in separation after the first touch [s]
  /// End of the last significant rebound [s]; the end of the run when this rebound has not ended, and the time of first contact
  /// without a significant rebound.
  double last_rebound_end = unset;
  /// Energy above that of the closed equilibrium after the first touch, when the drives are at their hold levels; at least 0
  /// [J].
  double landing_excess = unset;
  double end = unset;     ///< end of the run [s]
  bool reopened = false;  ///< true when the contact is open at the end of the run, by more than half of the contact gap

  [[nodiscard]] bool touched() const { return std::isfinite(initial_contact_time); }
  /// Returns true when the contact closed without a significant rebound.
  [[nodiscard]] bool is_bounce_free() const { return settled && bounce_count == 0; }
  /// Returns true when the closing was simulated to the end of its time window.
  [[nodiscard]] bool is_complete() const {
    return status == Status::done || status == Status::no_contact || status == Status::not_settled;
  }
};

/// Computes the figures of merit of a closing from its touches and rebounds.
class LandingFigures {
 public:
  explicit LandingFigures(const MetricsOptions& options = {}) : options_(options) {}
  void touch(const Touch& touch);
  void rebound(const Rebound& rebound);

  /// The facts about the contact point's motion up to the end of a run that figures of merit need.
  struct Course {
    bool sound = true;   ///< true when every point of the motion was finite, and the points were in order of time
    bool above = false;  ///< true when a rebound had not ended at the end of the run; this rebound was passed to rebound()
    FirstTouch first_touch = {};
    double last_time = 0;             ///< time of the last point of the motion [s]
    double closest = Metrics::unset;  ///< smallest distance to the contact plane before the first touch [m]
  };
  /// Returns the figures of merit of the run. Call it after the end of the run; see the function metrics() below.
  [[nodiscard]] Metrics metrics(const Trajectory& end, const Course& course) const;

 private:
  MetricsOptions options_;
  double highest_ = 0, first_duration_ = 0, last_end_ = Metrics::unset, separated_ = 0;
  Rebound latest_ = {};
  int significant_ = 0;
  bool touched_ = false;
  Touch touches_;  // all touches together
};

/// Computes the figures of merit of a closing while it runs, without storing the motion.
class MetricsObserver final : public ClosingObserver {
 public:
  /// Takes the distance `contact_gap` from rest to the contact plane [m].
  explicit MetricsObserver(double contact_gap, const MetricsOptions& options = {})
      : options_(options),
        figures_(options),
        rebounds_(contact_gap),
        charge_(options.transfer, contact_gap),
        contact_gap_(contact_gap),
        closest_(contact_gap) {}
  void knot(const TrajectoryPoint& point) override;
  void touch(const Touch& touch) override {
    if (touch.begin < options_.opening.time) figures_.touch(touch);
  }
  /// Returns the figures of merit of the run. Call it after the end of the run; see the function metrics() below.
  [[nodiscard]] Metrics metrics(const Trajectory& end);

 private:
  [[nodiscard]] LandingFigures::Course course() const;
  void begin_opening();

  MetricsOptions options_;
  LandingFigures figures_;
  ReboundFinder rebounds_;
  TransferredCharge charge_;
  // Distance from rest to the contact plane, and smallest distance to it before the first touch [m].
  double contact_gap_, closest_;
  TrajectoryPoint last_{.time = Metrics::unset};
  double make_charge_ = Metrics::unset;      // charge through the contact during closing, final once the opening has begun [C]
  std::optional<CommandedOpening> opening_;  // figures of the opening on command; empty before the command
  std::optional<LandingFigures::Course> landing_;  // motion of the contact point until the command to open
};

/// Returns all rebounds of a trajectory, significant or not, in order of time, up to the first motion point that is not finite.
/// A separation below 1e-12 of the contact gap does not count. Heights are extrema of the interpolated motion between its
/// points.
[[nodiscard]] std::vector<Rebound> rebounds(const Trajectory& trajectory);

/// Computes the figures of merit of a trajectory. Never throws: Metrics::status reports failures. This is the trajectory's own
/// status if that is not `done`; else done, no_contact, not_settled, or numerical_failure when a point of the motion is not
/// finite or goes back in time. The known figures depend on the run:
///
/// - A run that did not reach the end of its window: initial_contact_time and impact_velocity if the switch reached contact,
/// and no other figure.
/// - Several contacts: initial_contact_time and impact_velocity are those of the first touch of any contact. Rebounds count
/// from the time at which the connection closes (Device::connection: all of its contacts, or any of them). A connection that
/// never closes is not_settled.
/// - No contact: drive_energy and capacitance alone. This also holds for a run that began closed: such a run has no closing and
/// is not_settled until set_open_figures() finds the switch open and at rest.
/// - A run that ends at first contact, because the scene has no contact law: initial_contact_time, impact_velocity,
/// drive_energy.
/// - A run that ends less than one in_contact_period after the last significant rebound (after first contact without such a
/// rebound): not_settled, without permanent_contact_time and bounce_time. A run with a significant rebound also is not_settled
/// when in_contact_period is NaN.
[[nodiscard]] Metrics metrics(const Trajectory& trajectory, const MetricsOptions& options = {});

}  // namespace softland
