// The closed state under the hold levels. The drives keep a closed switch closed if a stable equilibrium on the contact exists.
// A switch that seems at rest at the end of its simulated time may still be leaving an unstable equilibrium, since such a
// motion grows from rounding errors.
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
  bool exists = false;  ///< true if an equilibrium of the closed switch with a contact force above zero exists
  /// True if the equilibrium is stable with every number of modes that can show an instability (judges_stability()). Unset if
  /// no number of modes can.
  std::optional<bool> stable;
  double contact_force = std::numeric_limits<double>::quiet_NaN();  ///< contact force in the closed equilibrium [N]
  /// Smallest eigenvalue of the stiffness in the closed equilibrium, relative to the mass [rad^2/s^2].
  double smallest_eigenvalue = std::numeric_limits<double>::quiet_NaN();
  /// Collapse voltage of each electrode that pulls towards the contact [V]: above this voltage the beam of the closed switch
  /// collapses onto the electrode. NaN for a voltage above ten times the hold level.
  std::map<std::string, double> pulled_through;
  /// The smallest eigenvalue and the collapse voltages with more modes (by_modes.h); none if the structure has no more modes.
  std::optional<ByModes> by_modes;
  std::map<std::string, ByModes> pulled_through_by_modes;
  bool flips = false;  ///< true if the closed equilibrium is stable for some numbers of modes and unstable for others
};

/// The voltages of an electrode between which a closed switch stays closed, with the other drives at a bias.
struct ClosedRange {
  double release = std::numeric_limits<double>::quiet_NaN();  ///< release voltage of the electrode, see release_voltage() [V]
  /// Collapse voltage of the electrode above its release voltage, see pull_through_voltage() [V].
  double pulled_through = std::numeric_limits<double>::quiet_NaN();
};
/// Returns the voltages between which an electrode keeps the switch closed. Both are NaN without contact, and for an electrode
/// on the far side (away from the contact).
[[nodiscard]] ClosedRange closed_range(const Switch& model, std::size_t electrode, std::vector<double> bias);

/// Returns the closed state under the hold levels (last levels) of these drives; the switch must have a contact.
[[nodiscard]] ClosedState closed_state(const PreparedScene& prepared, const std::vector<Signal>& signals);

/// True if a switch at rest under the levels `before` of its drives stays at rest under `levels`, because the forces at the
/// rest position balance.
[[nodiscard]] bool leaves_at_rest(const Switch& model, const std::vector<double>& before, const std::vector<double>& levels);

/// Returns a warning about a switch that stays at rest under its hold levels in an unstable equilibrium, from which any
/// asymmetry of a device closes the switch. Empty if the hold levels move the switch, or if the equilibrium is stable.
[[nodiscard]] std::string unstable_rest(const Switch& model, const std::vector<Signal>& signals);

/// Returns a warning about an unstable closed state of the switch; empty if the switch stays closed.
[[nodiscard]] std::string warning(const ClosedState& state);

}  // namespace softland
