// The hold: whether the hold levels (last levels) of the drives keep a closed switch closed, and with which contact force.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/closing.h"
#include "model/pull_in.h"
#include "model/trajectory.h"
#include "objectives/metrics.h"
#include "studies/closing/closed_state.h"
#include "waveforms/signal.h"

namespace softland {

/// Warning about a closing whose hold levels do not keep the switch closed.
inline constexpr std::string_view not_held =
    "the hold levels do not keep the switch closed: it has no closed equilibrium under them. They are below its release "
    "voltage, or so high that the electrode pulls the beam past the contact";

/// Returns a warning if the hold levels of these drives do not keep the switch closed; empty if they do. `state` is the closed
/// state under the hold levels.
[[nodiscard]] std::string hold_warning(const Switch& model, const std::vector<Signal>& signals, const ClosedState& state);

/// The effect of the hold levels of drives on a closed switch.
struct Hold {
  std::optional<ClosedEquilibrium> closed;  ///< equilibrium of the closed switch; none if the switch has no closed equilibrium
  /// Contact force in a stable closed equilibrium [N]. With several contacts it is the least of their forces if the connection
  /// needs all contacts, else the largest.
  double force = Metrics::unset;
  /// Contact force of each of several contacts [N]; empty if the hold levels do not keep the switch closed.
  std::vector<double> forces = {};
  /// Contact resistance [Ohm]; for several contacts, that of the electrical path through them; NaN if open or unknown.
  double resistance = Metrics::unset;
  /// Resistance of each of several contacts [Ohm]; empty if the hold levels do not keep the switch closed.
  std::vector<double> resistances = {};
  /// True if the hold levels keep the switch closed: its closed equilibrium is stable or, without a closed equilibrium,
  /// adhesion may keep it closed. Also true for a switch without a contact.
  bool is_held = true;
  /// Returns the contact force above which a contact counts as steady [N]; NaN if the hold levels do not keep the switch
  /// closed.
  [[nodiscard]] double steady_force(const MetricsOptions& options) const { return options.steady_force * force; }
};
/// Computes the hold (equilibrium, contact force, resistance) of the closed switch under these levels, one per drive [V].
/// `near` is a closed equilibrium of a similar switch under similar levels, at which the search for the equilibrium starts.
[[nodiscard]] Hold hold_under(const Switch& model, const std::vector<double>& levels,
                              const std::optional<ClosedEquilibrium>& near = {});
/// Computes the hold (equilibrium, contact force, resistance) of the closed switch under the hold levels of these drives.
[[nodiscard]] inline Hold hold_of(const Switch& model, const std::vector<Signal>& signals,
                                  const std::optional<ClosedEquilibrium>& near = {}) {
  return hold_under(model, hold_levels(signals), near);
}
/// Stores in `trajectory` the hold force, and whether the hold levels keep the switch closed.
void set_hold(Trajectory& trajectory, const Hold& hold);
/// Stores in `trajectory` the members that set_hold() sets, and the capacitance of the switch at rest under the hold levels.
void set_rest(Trajectory& trajectory, const Switch& model, const std::vector<Signal>& signals, const Hold& hold);
/// Returns the options of metrics() with the load circuit of the switch. The run begins in the state `start`; `held` has the
/// drive signals until the command to open.
[[nodiscard]] MetricsOptions with_load(MetricsOptions options, const Switch& model, StartState start,
                                       const std::vector<Signal>& held);
/// True if a run that began closed is open at the end and does not close again.
[[nodiscard]] bool has_opened(const Trajectory& run);

}  // namespace softland
