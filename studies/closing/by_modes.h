// What more modes say of the statics of a switch: its equilibria, whether they are stable, and its voltages.
//
// A verdict about a switch may belong to the number of modes that its scene keeps, and so may a voltage: the closed state of a
// bridge that its electrode pulls through on one side is the less stable, the more modes it has, and a bridge that is bent by
// many of its thicknesses hangs like a membrane, which few modes of bending make too stiff. Statics are cheap, so they are
// computed with the modes of the scene, with twice and with four times as many, up to most_static_modes: symmetric ones and
// antisymmetric ones.
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

/// A voltage that more modes move by more than this, relative, is told with the one that they lead to.
inline constexpr double mode_shift_worth_telling = 0.01;

/// One number, such as a voltage or an eigenvalue, by the number of modes that it was found with.
struct ByModes {
  std::map<int, double> values = {};  ///< NaN where there is none
  /// What further modes would lead to: by Aitken's extrapolation of a geometric series, or with as many as there are for statics.
  /// NaN where the values do not converge.
  double converged = std::numeric_limits<double>::quiet_NaN();
  /// That, or where it is not known the value with the most modes, less the first value, relative to that. Infinite where more
  /// modes make a value come or go, NaN where there is none.
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
  /// Whether there are more modes than the scene has.
  [[nodiscard]] bool exists() const { return !richer_.empty(); }
  /// The switches, that of the scene first. Valid as long as the scene and that are.
  [[nodiscard]] std::vector<const Switch*> switches() const;
  /// That with most_static_modes, built when it is first asked for.
  [[nodiscard]] const Switch& finest() const;
  /// Builds that with this number of modes, up to most_static_modes.
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

/// Whether the equilibria are stable, by their smallest eigenvalues. One that is missing (NaN) is not.
struct StabilityByModes {
  ByModes eigenvalues;         ///< [rad^2/s^2]
  std::optional<bool> stable;  ///< with every number of modes that can tell, and by the eigenvalue that they lead to
  bool flips = false;          ///< some of those say yes, others no
};
[[nodiscard]] StabilityByModes stability(const ModeLadder& ladder, std::span<const std::optional<ClosedEquilibrium>> closed);
/// The same of the open equilibrium.
[[nodiscard]] StabilityByModes open_stability(const ModeLadder& ladder, std::span<const double> volts);

/// Static voltages of an electrode under the bias of the other drives (bias_of()) [V].
struct VoltagesByModes {
  ByModes static_pull_in, release, pulled_through;  ///< without values where there is no contact
};
/// `pulled_through` is that of the scene, from its release voltage on.
[[nodiscard]] VoltagesByModes voltages_by_modes(const ModeLadder& ladder, const Scene& scene, std::size_t electrode,
                                                double pulled_through);
[[nodiscard]] ByModes static_pull_in_by_modes(const ModeLadder& ladder, const Scene& scene, std::size_t electrode);
/// pull_through_voltage() by modes; `own` is that of the scene, if there is one [V].
[[nodiscard]] ByModes pulled_through_by_modes(const ModeLadder& ladder, std::size_t electrode, std::vector<double> volts,
                                              double own);

/// Capacitance of the searched electrode in the closed state under these voltages [F], of a switch that lands on the face of a
/// dielectric. Also with the most modes that a closing takes, where more modes move it by what is worth telling.
[[nodiscard]] ByModes closed_capacitance_by_modes(const ModeLadder& ladder, std::span<const double> volts);
/// Returns how many of the modes that were tried hold a value to mode_shift_worth_telling of what it converges to; none where no
/// number does, or it does not converge.
[[nodiscard]] std::optional<int> modes_needed(const ByModes& found);

/// "−6.1 %, to 142.7 V": by how much more modes move a voltage, or another value, and to what where that is worth telling.
[[nodiscard]] std::string shift_words(const ByModes& value, std::string_view unit = "V");

/// Sentences for the static pull-in voltages of a scene, and for the capacitance of its closed state, that are worth telling.
[[nodiscard]] std::vector<std::string> mode_warnings(const PreparedScene& prepared);

}  // namespace softland
