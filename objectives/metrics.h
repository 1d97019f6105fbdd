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

/// Figures that appear in results only for scenes that request them.
struct AskedFigures {
  bool resistance = false;    ///< true when the contacts that make the connection have a resistivity
  bool electrical = false;    ///< true when the device requests electrical figures (Device::electrical)
  bool opening = false;       ///< true when the run opens the switch on command
  bool pressure = false;      ///< true when a contact that makes the connection has summits and a hardness
  bool charge = false;        ///< true when the device has a load circuit (Device::load)
  bool break_charge = false;  ///< true when the device has a load circuit, and the run opens on command
  bool operator==(const AskedFigures&) const = default;
};
/// Returns the figures that a device requests.
[[nodiscard]] inline AskedFigures asked_figures(const Device& device) {
  return {.resistance = device.conducts(),
          .electrical = device.electrical.is_asked(),
          .pressure =
              std::ranges::any_of(device.contacts, [](const Contact& c) { return c.connects && summit_pressure_scale(c) > 0; }),
          .charge = device.load.is_given()};
}

struct MetricsOptions {
  double significant_rebound = 1e-9;  ///< a rebound counts when it is higher than this [m]
  double steady_force = 0.1;          ///< the contact force is steady when it is above this share of the hold force
  AskedFigures asked = {};
  OpeningCommand opening = {};    ///< command to open; figures of the closing count until the time of this command
  TransferOptions transfer = {};  ///< load circuit for the transferred charge; set when Device::load is given
};

struct Metrics {
  static constexpr double unset = std::numeric_limits<double>::quiet_NaN();

  Status status = Status::not_run;
  double initial_contact_time = unset;     ///< t_i, time of first contact [s]
  double permanent_contact_time = unset;   ///< t_p, time from which the contact stays closed [s]; NaN when not settled
  double bounce_time = unset;              ///< t_b = t_p - t_i, duration of bouncing [s]
  int bounce_count = 0;                    ///< N_B, number of significant rebounds; meaningless without contact
  double major_bounce_height = unset;      ///< B_H, height of the highest rebound [m]; 0 when there is no rebound
  double first_rebound_time = unset;       ///< duration of the first significant rebound [s]; 0 without a rebound
  double impact_velocity = unset;          ///< v_i, impact velocity of the first touch [m/s]
  double peak_contact_force = unset;       ///< largest contact force of the run [N]
  double impact_energy = unset;            ///< sum over touches of the largest stored contact energy [J]
  double hold_force = unset;               ///< contact force in the equilibrium under the hold levels [N]
  double steady_force_time = unset;        ///< Trajectory::steady_force_time [s]
  double least_force_after_touch = unset;  ///< Trajectory::least_force_after_touch [N]
  double capacitance = unset;              ///< Trajectory::hold_capacitance [F]
  double drive_energy = unset;             ///< energy that the drives give [J]
  bool settled = false;
  double resistance = unset;           ///< Trajectory::hold_resistance [Ohm]
  double electrical_contact = unset;   ///< ElectricalOutcome::first_closed [s]
  double electrical_settling = unset;  ///< ElectricalOutcome::closed_from [s]
  int electrical_bounces = 0;          ///< ElectricalOutcome::openings; meaningless when the switch never closes electrically
  double pressure = unset;             ///< largest Touch::pressure of the run
  /// Charge through the contact until the command to open, or the end of the run [C]; see objectives/transferred_charge.h.
  double make_charge = unset;
  double break_charge = unset;  ///< charge through the contact after the command to open [C]
  AskedFigures asked = {};      ///< MetricsOptions::asked
  // The following figures are known when the drives command the switch to open: see OpeningOnCommand.
  double open_command = unset;           ///< time of the command to open [s]
  double opening_time = unset;           ///< time from the command to open to the last break of the contact [s]
  int release_bounces = 0;               ///< bounces on opening; meaningless if the run ends closed
  double release_bounce_height = unset;  ///< highest separation on opening that ends in a touch [m]; 0 without a bounce
  double release_settling_time = unset;  ///< time from the command to open to rest in the open state [s]
  double overshoot_open = unset;         ///< largest excursion beyond the open position, away from the contact [m]
  double least_gap_open = unset;         ///< smallest separation after the opening [m]
  double closed_time = unset;            ///< time in contact from the first touch to the last break [s]
  /// Largest impact velocity on a back stop after the command to open, 0 without an impact [m/s]; set by simulate().
  double back_stop_velocity = unset;
  // simulate() sets the following figures when the switch never touches: see set_open_figures().
  double static_deflection = unset;  ///< position of the contact point in the open equilibrium under the hold levels [m]
  double overshoot = unset;          ///< largest excursion beyond static_deflection, away from the initial position [m]
  /// Time from which the contact point stays near static_deflection [s]; NaN when the point does not.
  double open_settling_time = unset;
  // simulate() sets the following figures, which depend on the drives.
  /// Largest |V| of the electrodes' drives in the window; that of the piezo's drive when there is no electrode [V].
  double peak_voltage = unset;
  double peak_slew = unset;                ///< largest |dV/dt| of any drive [V/s]; infinite for a jump of the voltage
  double largest_impact_velocity = unset;  ///< largest impact velocity of all touches, not only of the first [m/s]
  // The following figures enter costs; results do not show them.
  double closest = unset;    ///< smallest separation before the first touch [m]; known also without contact
  double separated = unset;  ///< time above the first-touch plane after the first touch [s]
  /// End of the last significant rebound; end of the run when the last rebound has not ended; first contact without a
  /// significant rebound [s].
  double last_rebound_end = unset;
  double landing_excess = unset;  ///< Trajectory::landing_excess, but not below 0 [J]
  double end = unset;             ///< end of the run [s]
  bool reopened = false;          ///< true when the contact is open at the end of the run, by more than half of the contact gap

  [[nodiscard]] bool touched() const { return std::isfinite(initial_contact_time); }
  /// Returns true when the contact settled without a significant rebound.
  [[nodiscard]] bool lands() const { return settled && bounce_count == 0; }
  /// Returns true when the closing was simulated to the end of its window.
  [[nodiscard]] bool is_complete() const {
    return status == Status::done || status == Status::no_contact || status == Status::not_settled;
  }
};

/// Computes the figures of a closing from its touches and rebounds.
class LandingFigures {
 public:
  explicit LandingFigures(const MetricsOptions& options = {}) : options_(options) {}
  void touch(const Touch& touch);
  void rebound(const Rebound& rebound);

  /// The motion of the contact point up to the end of a run.
  struct Course {
    bool sound = true;   ///< true when every knot was finite, and the knots were in order of time
    bool above = false;  ///< true when the last rebound, already passed to rebound(), had not ended at the end of the run
    FirstTouch first_touch = {};
    double last_time = 0;             ///< time of the last knot [s]
    double closest = Metrics::unset;  ///< smallest separation before the first touch [m]
  };
  /// Returns the figures of the run. Call it after the end of the run; see the function metrics() below.
  [[nodiscard]] Metrics metrics(const Trajectory& end, const Course& course) const;

 private:
  MetricsOptions options_;
  double highest_ = 0, first_duration_ = 0, last_end_ = Metrics::unset, separated_ = 0;
  Rebound latest_ = {};
  int significant_ = 0;
  bool touched_ = false;
  double peak_force_ = 0, impact_energy_ = 0, largest_impact_velocity_ = 0, pressure_ = Metrics::unset;
};

/// Computes the figures of merit during a closing, without storing its motion.
class MetricsObserver final : public ClosingObserver {
 public:
  /// `contact_gap` is in [m].
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
  /// Returns the figures of the run. Call it after the end of the run; see the function metrics() below.
  [[nodiscard]] Metrics metrics(const Trajectory& end);

 private:
  [[nodiscard]] LandingFigures::Course course() const;
  void begin_opening();

  MetricsOptions options_;
  LandingFigures figures_;
  ReboundFinder rebounds_;
  TransferredCharge charge_;
  double contact_gap_, closest_;  // contact gap, and smallest separation before the first touch [m]
  TrajectoryPoint last_{.time = Metrics::unset};
  double make_charge_ = Metrics::unset;            // charge during closing, complete once the opening has begun [C]
  std::optional<CommandedOpening> opening_;        // opening on command; empty before the command
  std::optional<LandingFigures::Course> landing_;  // motion of the closing until the command to open
};

/// Returns all rebounds, significant or not, in order of time, up to the first knot that is not finite. A separation below
/// 1e-12 of the contact gap does not count. Heights are extrema of the trajectory's interpolant, not of its knots.
[[nodiscard]] std::vector<Rebound> rebounds(const Trajectory& trajectory);

/// Computes the figures of a trajectory. Never throws: the status reports failures. It is the trajectory's own status if that
/// is not `done`; else done, no_contact, not_settled, or numerical_failure when a knot is not finite or goes back in time. The
/// known figures depend on the run:
///
/// - A run that did not reach the end of its window: initial_contact_time and impact_velocity if the switch reached contact,
/// and no other figure.
/// - Several contacts: initial_contact_time and impact_velocity are those of the first touch of any contact. Rebounds count
/// from the time at which all contacts of the connection, or any of them, are closed. A connection that never closes is
/// not_settled.
/// - No contact: drive_energy and capacitance alone. This also holds for a run that began closed: such a run has no closing and
/// is not_settled until set_open_figures() finds the switch open and at rest.
/// - A run that ends at first contact, because the scene has no contact law: initial_contact_time, impact_velocity,
/// drive_energy.
/// - Not settled: less than one in_contact_period after permanent contact (first contact when there is no significant rebound),
/// or a significant rebound and a period that is NaN.
[[nodiscard]] Metrics metrics(const Trajectory& trajectory, const MetricsOptions& options = {});

}  // namespace softland
