// The effect of more modes on the statics of a switch: its equilibria, their stability, and its voltages.
//
// A verdict about a switch may depend on the number of modes that its scene keeps, and so may a voltage. The closed state of a
// bridge that collapses onto its electrode on one side is the less stable, the more modes it has. A bridge that is bent by many
// of its thicknesses acts like a membrane, which few bending modes make too stiff. Statics are cheap, so they are computed with
// the modes of the scene, with twice and with four times as many, up to most_static_modes: symmetric ones and antisymmetric
// ones.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studies/closing/prepared.h"

namespace softland {

/// Least relative shift of a voltage by more modes that is reported, with the value that they lead to.
inline constexpr double mode_shift_worth_telling = 0.01;

/// One number, such as a voltage or an eigenvalue, by the number of modes that it was found with.
struct ByModes {
  std::map<int, double> values = {};  ///< NaN: no value
  /// Limit for further modes: by Aitken's extrapolation of a geometric series, or with the most modes for statics. NaN if the
  /// values do not converge.
  double converged = std::numeric_limits<double>::quiet_NaN();
  /// Relative change from the first value to the limit, or to the value with the most modes if the limit is not known. Infinite
  /// if more modes make a value come or go, NaN without values.
  [[nodiscard]] double moved() const;
  [[nodiscard]] bool is_worth_telling() const;
};
/// Extrapolates values by the number of modes.
[[nodiscard]] ByModes by_modes(std::map<int, double> values);

/// The switches of a scene with its own modes and with more. A plate and a table of modes have no more.
class ModeLadder {
 public:
  /// `own` is the switch of the scene.
  ModeLadder(const Scene& scene, const Switch& own);
  explicit ModeLadder(const PreparedScene& prepared) : ModeLadder(prepared.scene, prepared.model) {}
  /// True if more modes than the scene's are possible.
  [[nodiscard]] bool exists() const { return !richer_.empty(); }
  /// The switches, that of the scene first. Valid as long as the scene and its switch are.
  [[nodiscard]] std::vector<const Switch*> switches() const;
  /// The switch with most_static_modes, built at the first call.
  [[nodiscard]] const Switch& finest() const;
  /// Builds the switch with this number of modes, up to most_static_modes.
  [[nodiscard]] Switch with(int modes) const;

 private:
  const Scene* scene_;
  const Switch* own_;
  std::vector<Switch> richer_;
  mutable std::optional<Switch> finest_;
};

/// The closed equilibria under constant voltages, that of the scene first; each is found from the one before.
[[nodiscard]] std::vector<std::optional<ClosedEquilibrium>> closed_equilibria(const ModeLadder& ladder,
                                                                              std::span<const double> volts);

/// Stability of the equilibria, by their smallest eigenvalues. A missing one (NaN) is not stable.
struct StabilityByModes {
  ByModes eigenvalues;         ///< [rad^2/s^2]
  std::optional<bool> stable;  ///< true if stable with every number of modes that can tell, and by the limit of the eigenvalue
  bool flips = false;          ///< some of those are stable, others not
};
[[nodiscard]] StabilityByModes stability(const ModeLadder& ladder, std::span<const std::optional<ClosedEquilibrium>> closed);
/// The same of the open equilibrium.
[[nodiscard]] StabilityByModes open_stability(const ModeLadder& ladder, std::span<const double> volts);

/// Static voltages of an electrode under the bias of the other drives (bias_of()) [V].
struct VoltagesByModes {
  ByModes static_pull_in, release, pulled_through;  ///< without values if there is no contact
};
/// Finds the voltages. `pulled_through` is the scene's collapse voltage, from its release voltage on.
[[nodiscard]] VoltagesByModes voltages_by_modes(const ModeLadder& ladder, const Scene& scene, std::size_t electrode,
                                                double pulled_through);
[[nodiscard]] ByModes static_pull_in_by_modes(const ModeLadder& ladder, const Scene& scene, std::size_t electrode);
/// pull_through_voltage() by modes; `own` is that of the scene, if it has one [V].
[[nodiscard]] ByModes pulled_through_by_modes(const ModeLadder& ladder, std::size_t electrode, std::vector<double> volts,
                                              double own);

/// Capacitance of the searched electrode in the closed state under these voltages [F], for a switch that lands on the face of a
/// dielectric. Also with the most modes that a closing takes, if more modes move it by a reported amount.
[[nodiscard]] ByModes closed_capacitance_by_modes(const ModeLadder& ladder, std::span<const double> volts);
/// Returns the least tried number of modes from which on values stay within mode_shift_worth_telling of the limit; none if the
/// last one does not, or the values do not converge.
[[nodiscard]] std::optional<int> modes_needed(const ByModes& found);

/// "−6.1 %, to 142.7 V": the shift of a voltage, or another value, by more modes, and its limit if that is reported.
[[nodiscard]] std::string shift_prose(const ByModes& value, std::string_view unit = "V");

/// Sentences about shifts of a scene's static pull-in voltages, and of the capacitance of its closed state, that are reported.
[[nodiscard]] std::vector<std::string> mode_warnings(const PreparedScene& prepared);

}  // namespace softland
