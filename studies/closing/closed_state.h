// The closed state under the hold levels. The drives keep a closed switch closed if a stable equilibrium on the contact exists.
// A switch that seems at rest at the end of its window may still be leaving an unstable equilibrium, since such a motion grows
// from rounding errors.
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
  bool exists = false;         ///< true if an equilibrium with a contact force above zero exists
  std::optional<bool> stable;  ///< true if stable with every number of modes that is large enough to decide; unset if none is
  double contact_force = std::numeric_limits<double>::quiet_NaN();        ///< contact force of the equilibrium [N]
  double smallest_eigenvalue = std::numeric_limits<double>::quiet_NaN();  ///< ClosedEquilibrium::smallest_eigenvalue of the
                                                                          ///< equilibrium [rad^2/s^2]
  /// Collapse voltage of each electrode that pulls towards the contact [V]: above this voltage the beam of the closed switch
  /// collapses onto the electrode. NaN for a voltage above ten times the hold level.
  std::map<std::string, double> pulled_through;
  /// The smallest eigenvalue and the collapse voltages with more modes (by_modes.h); none if the structure has no more modes.
  std::optional<ByModes> by_modes;
  std::map<std::string, ByModes> pulled_through_by_modes;
  bool flips = false;  ///< true if the closed equilibrium is stable only for some numbers of modes
};

/// The voltages of an electrode between which a closed switch stays closed, with the other drives at a bias.
struct ClosedRange {
  double release = std::numeric_limits<double>::quiet_NaN();         ///< release voltage, see release_voltage() [V]
  double pulled_through = std::numeric_limits<double>::quiet_NaN();  ///< collapse voltage above the release voltage, see
                                                                     ///< pull_through_voltage() [V]
};
/// Returns the voltages between which an electrode keeps the switch closed. Both are NaN without contact, and for an electrode
/// on the far side.
[[nodiscard]] ClosedRange closed_range(const Switch& model, std::size_t electrode, std::vector<double> bias);

/// Returns the closed state under the hold levels of these drives; the switch must have a contact.
[[nodiscard]] ClosedState closed_state(const PreparedScene& prepared, const std::vector<Signal>& signals);

/// True if a switch at rest under the levels `before` of its drives stays at rest under `levels`, because the forces at the
/// rest position balance.
[[nodiscard]] bool leaves_at_rest(const Switch& model, const std::vector<double>& before, const std::vector<double>& levels);

/// Returns a warning about a switch that stays at rest under its hold levels in an unstable equilibrium, from which any
/// asymmetry of a device closes the switch. Empty if the hold levels move the switch, or if the equilibrium is stable.
[[nodiscard]] std::string unstable_rest(const Switch& model, const std::vector<Signal>& signals);

/// Returns a warning about an unstable closed state; empty if the switch stays closed.
[[nodiscard]] std::string warning(const ClosedState& state);

}  // namespace softland
