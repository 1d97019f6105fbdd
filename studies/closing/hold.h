// The effect of hold levels on a closed switch: whether it stays closed, and with which force.
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

/// Warning about a trajectory that is not held.
inline constexpr std::string_view not_held =
    "the hold levels do not keep the switch closed: it has no closed equilibrium under them. They are below its release "
    "voltage, or so high that the electrode pulls the beam past the contact";

/// Returns the warning if the hold levels of these drives do not keep a switch closed whose closed state under them is `state`;
/// empty if they do.
[[nodiscard]] std::string hold_warning(const Switch& model, const std::vector<Signal>& signals, const ClosedState& state);

/// The effect of the hold levels of drives on a closed switch.
struct Hold {
  std::optional<ClosedEquilibrium> closed;  ///< none if the switch has no closed equilibrium
  double force = Metrics::unset;            ///< force of the contact, if it is stable, or of the connection of several [N]
  std::vector<double> forces = {};          ///< force of each of several contacts [N]; empty if no state holds
  double resistance =
      Metrics::unset;  ///< resistance of the contact, or of the connection of several [Ohm]; NaN: open, or not known
  std::vector<double> resistances = {};  ///< resistance of each of several contacts [Ohm]; empty if no state holds
  /// True if the switch is held. False if it has a contact and no such equilibrium, unless the contact may hold by adhesion,
  /// and if the equilibrium is unstable.
  bool is_held = true;
  /// ClosingOptions::steady_force [N]; NaN if the switch is not held.
  [[nodiscard]] double steady_force(const MetricsOptions& options) const { return options.steady_force * force; }
};
/// Computes the hold under these levels, one per drive of the switch [V]. `near` is the equilibrium of a switch and drives that
/// differ little, from which this one is found sooner.
[[nodiscard]] Hold hold_under(const Switch& model, const std::vector<double>& levels,
                              const std::optional<ClosedEquilibrium>& near = {});
/// Computes the hold under the hold levels of these drives.
[[nodiscard]] inline Hold hold_of(const Switch& model, const std::vector<Signal>& signals,
                                  const std::optional<ClosedEquilibrium>& near = {}) {
  return hold_under(model, hold_levels(signals), near);
}
/// Sets the hold force, and whether the switch is held.
void set_hold(Trajectory& trajectory, const Hold& hold);
/// Sets the same, and the capacitance of the state in which the hold levels leave the switch.
void set_rest(Trajectory& trajectory, const Switch& model, const std::vector<Signal>& signals, const Hold& hold);
/// Returns the options with the load that the switch carries, for a run from this state whose drives until the command to open
/// are these.
[[nodiscard]] MetricsOptions with_load(MetricsOptions options, const Switch& model, StartState start,
                                       const std::vector<Signal>& held);
/// True if a run that began closed has left its contact for good.
[[nodiscard]] bool has_opened(const Trajectory& run);

}  // namespace softland
