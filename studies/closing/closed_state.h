// Whether the drives keep a closed switch closed: by its equilibrium on the contact, and by the tangent there. A closing that is
// quiet at the end of its window may yet be leaving an unstable one, as slowly as rounding has begun it.
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
  std::optional<bool> stable;  ///< with every number of modes that can tell; not set where none can, or there is no equilibrium
  double contact_force = std::numeric_limits<double>::quiet_NaN();        ///< there [N]
  double smallest_eigenvalue = std::numeric_limits<double>::quiet_NaN();  ///< ClosedEquilibrium::smallest_eigenvalue [rad^2/s^2]
  /// By electrode that pulls towards the contact: voltage from which on the closed switch is pulled through [V]; NaN where there
  /// is none within ten times its hold level.
  std::map<std::string, double> pulled_through;
  /// The smallest eigenvalue and those voltages with more modes (by_modes.h); none where there are no more.
  std::optional<ByModes> by_modes;
  std::map<std::string, ByModes> pulled_through_by_modes;
  bool flips = false;  ///< StabilityByModes::flips
};

/// The voltages of an electrode between which a closed switch stays closed, its other drives at a bias.
struct ClosedRange {
  double release = std::numeric_limits<double>::quiet_NaN();         ///< release_voltage() [V]
  double pulled_through = std::numeric_limits<double>::quiet_NaN();  ///< pull_through_voltage() from there on [V]
};
/// Without contact, and of an electrode on the far side, neither.
[[nodiscard]] ClosedRange closed_range(const Switch& model, std::size_t electrode, std::vector<double> bias);

/// Under the hold levels of these drives, of a switch that has a contact.
[[nodiscard]] ClosedState closed_state(const PreparedScene& prepared, const std::vector<Signal>& signals);

/// Whether a switch at rest under the values `before` of its drives stays where it is under these levels: forces that balance
/// there.
[[nodiscard]] bool leaves_at_rest(const Switch& model, const std::vector<double>& before, const std::vector<double>& levels);

/// What is to be warned of in a switch that its hold levels leave where it rests, in an equilibrium that is unstable: the least
/// asymmetry of a device closes it. Empty where they move it, or it is stable.
[[nodiscard]] std::string unstable_rest(const Switch& model, const std::vector<Signal>& signals);

/// What is to be warned of; empty where the switch stays closed.
[[nodiscard]] std::string warning(const ClosedState& state);

}  // namespace softland
