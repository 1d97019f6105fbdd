// What drives do to a closed switch once they stand at their hold levels: whether it stays, and with which force.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/pull_in.h"
#include "model/trajectory.h"
#include "objectives/metrics.h"
#include "studies/closing/closed_state.h"
#include "waveforms/signal.h"

namespace softland {

/// What is to be warned of where a trajectory is not held.
inline constexpr std::string_view not_held =
    "the hold levels do not keep the switch closed: it has no closed equilibrium under them. They are below its release "
    "voltage, or so high that the electrode pulls the beam past the contact";

/// What is to be warned of where the hold levels of these drives do not keep a switch closed whose closed state under them is
/// `state`; empty where they do.
[[nodiscard]] std::string hold_warning(const Switch& model, const std::vector<Signal>& signals, const ClosedState& state);

/// What the hold levels of drives do to a closed switch.
struct Hold {
  std::optional<ClosedEquilibrium> closed;  ///< if there is one
  double force = Metrics::unset;            ///< of the contact, where it is stable, or of the connection of several [N]
  std::vector<double> forces = {};          ///< of each of several contacts [N]; empty where no state holds
  double resistance = Metrics::unset;       ///< of the contact, or of the connection of several [Ohm]; NaN: open, or not known
  std::vector<double> resistances = {};     ///< of each of several contacts [Ohm]; empty where no state holds
  /// Whether anything holds the switch: not where it has a contact and no such equilibrium, unless the contact may hold on by
  /// adhesion, nor where it is unstable.
  bool is_held = true;
  /// ClosingOptions::steady_force [N]; NaN where nothing holds the switch.
  [[nodiscard]] double steady_force(const MetricsOptions& options) const { return options.steady_force * force; }
};
/// What these levels do, one per drive of the switch [V]. `near`: the equilibrium of a switch and drives little different, from
/// which this one is found sooner.
[[nodiscard]] Hold hold_under(const Switch& model, const std::vector<double>& levels,
                              const std::optional<ClosedEquilibrium>& near = {});
/// What the hold levels of these drives do.
[[nodiscard]] inline Hold hold_of(const Switch& model, const std::vector<Signal>& signals,
                                  const std::optional<ClosedEquilibrium>& near = {}) {
  return hold_under(model, hold_levels(signals), near);
}
/// Sets hold force and whether anything holds the switch.
void set_hold(Trajectory& trajectory, const Hold& hold);
/// The same, and the capacitance where the hold levels leave the switch.
void set_rest(Trajectory& trajectory, const Switch& model, const std::vector<Signal>& signals, const Hold& hold);
/// The same options for a run of this switch, whose contact these levels hold closed, one per drive [V]: with the load that it
/// switches.
[[nodiscard]] MetricsOptions with_load(MetricsOptions options, const Switch& model, const std::vector<double>& holding);
/// Whether a run that began closed has left its contact for good.
[[nodiscard]] bool has_opened(const Trajectory& run);

}  // namespace softland
