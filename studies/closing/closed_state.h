// The closed state under the hold levels: the drives keep a closed switch closed if it has a stable equilibrium on the contact.
// A closing that is quiet at the end of its window may still be leaving an unstable one, with a motion that began as rounding.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "studies/closing/by_modes.h"
#include "studies/closing/prepared.h"

namespace softland {

struct ClosedState {
  bool exists = false;         ///< an equilibrium with a contact force above zero
  std::optional<bool> stable;  ///< true if stable with every number of modes that can tell; unset if none can
  double contact_force = std::numeric_limits<double>::quiet_NaN();        ///< contact force there [N]
  double smallest_eigenvalue = std::numeric_limits<double>::quiet_NaN();  ///< ClosedEquilibrium::smallest_eigenvalue [rad^2/s^2]
  /// Voltage of each electrode that pulls towards the contact from which on the closed switch collapses onto it [V]. NaN if it
  /// does not within ten times the hold level.
  std::map<std::string, double> pulled_through;
  /// The smallest eigenvalue and those voltages with more modes (by_modes.h); none if more modes are impossible.
  std::optional<ByModes> by_modes;
  std::map<std::string, ByModes> pulled_through_by_modes;
  bool flips = false;  ///< StabilityByModes::flips
};

/// The voltages of an electrode between which a closed switch stays closed, its other drives at a bias.
struct ClosedRange {
  double release = std::numeric_limits<double>::quiet_NaN();         ///< release_voltage() [V]
  double pulled_through = std::numeric_limits<double>::quiet_NaN();  ///< pull_through_voltage() from there on [V]
};
/// Returns the range; neither voltage without contact, or for an electrode on the far side.
[[nodiscard]] ClosedRange closed_range(const Switch& model, std::size_t electrode, std::vector<double> bias);

/// Returns the closed state under the hold levels of these drives, for a switch with a contact.
[[nodiscard]] ClosedState closed_state(const PreparedScene& prepared, const std::vector<Signal>& signals);

/// True if a switch at rest under the values `before` of its drives stays there under these levels: forces that balance at
/// rest.
[[nodiscard]] bool leaves_at_rest(const Switch& model, const std::vector<double>& before, const std::vector<double>& levels);

/// Warning about a switch that its hold levels leave at rest in an unstable equilibrium: the least asymmetry of a device closes
/// it. Empty if they move it, or if the equilibrium is stable.
[[nodiscard]] std::string unstable_rest(const Switch& model, const std::vector<Signal>& signals);

/// Warning about the closed state; empty if the switch stays closed.
[[nodiscard]] std::string warning(const ClosedState& state);

}  // namespace softland
