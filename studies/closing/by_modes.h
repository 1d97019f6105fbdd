// The effect of more modes on the statics of a switch: equilibria, their stability, and pull-in, release and collapse voltages.
//
// The stability of a switch, and its static voltages, may depend on the number of modes in the scene. For a bridge that
// collapses onto its electrode on one side, the closed state is the less stable, the more modes the model has. A bridge that is
// bent by many of its thicknesses acts like a membrane, for which few bending modes are too stiff. Statics are cheap, so they
// are computed with the modes of the scene, with twice and with four times as many, up to most_static_modes, symmetric and
// antisymmetric.
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

/// Least relative change of a static voltage by more modes that results report, together with the converged voltage.
inline constexpr double mode_shift_worth_telling = 0.01;

/// A number, such as a voltage or an eigenvalue, computed with several numbers of modes.
struct ByModes {
  std::map<int, double> values = {};  ///< values of the voltage or eigenvalue, by number of modes; NaN: no value
  /// Limit of the values for many modes: the last value if it hardly changed, else Aitken's extrapolation of a geometric
  /// series. NaN if the values do not converge.
  double converged = std::numeric_limits<double>::quiet_NaN();
  /// Relative change from the first value to the limit, or to the value with the most modes if the limit is not known. Infinite
  /// if the value exists with some numbers of modes only, NaN without values.
  [[nodiscard]] double moved() const;
  [[nodiscard]] bool is_worth_telling() const;
};
/// Returns values by number of modes together with their extrapolated limit.
[[nodiscard]] ByModes by_modes(std::map<int, double> values);

/// The switches of a scene with the scene's own modes and with more modes. A plate and a table of modes have no further modes.
class ModeLadder {
 public:
  /// `own` is the switch of the scene, with the scene's modes.
  ModeLadder(const Scene& scene, const Switch& own);
  explicit ModeLadder(const PreparedScene& prepared) : ModeLadder(prepared.scene, prepared.model) {}
  /// True if the structure has more modes than the scene uses.
  [[nodiscard]] bool exists() const { return !richer_.empty(); }
  /// Returns the switches in rising number of modes, that of the scene first. The pointers are valid as long as `this`, the
  /// scene and its switch exist.
  [[nodiscard]] std::vector<const Switch*> switches() const;
  /// Returns the switch with most_static_modes, built at the first call.
  [[nodiscard]] const Switch& finest() const;
  /// Returns the switch of the scene with this number of modes, at most most_static_modes.
  [[nodiscard]] Switch with(int modes) const;

 private:
  const Scene* scene_;
  const Switch* own_;
  std::vector<Switch> richer_;
  mutable std::optional<Switch> finest_;
};

/// Returns the closed equilibrium under constant voltages for every switch of `ladder` (in rising number of modes); none where
/// it does not exist. Each search starts from the equilibrium with fewer modes.
[[nodiscard]] std::vector<std::optional<ClosedEquilibrium>> closed_equilibria(const ModeLadder& ladder,
                                                                              std::span<const double> volts);

/// Stability of equilibria with several numbers of modes, by the smallest eigenvalues. A missing equilibrium (NaN) is not
/// stable.
struct StabilityByModes {
  ByModes eigenvalues;  ///< smallest eigenvalue of the equilibrium, by number of modes [rad^2/s^2]
  /// True if the equilibrium is stable in the limit of many modes, and with every number of modes that can show an instability
  /// (judges_stability()). Unset if no number of modes can.
  std::optional<bool> stable;
  /// True if the equilibrium is stable with some of the computed numbers of modes and unstable with others.
  bool flips = false;
};
[[nodiscard]] StabilityByModes stability(const ModeLadder& ladder, std::span<const std::optional<ClosedEquilibrium>> closed);
/// Returns the stability of the open equilibrium under constant voltages.
[[nodiscard]] StabilityByModes open_stability(const ModeLadder& ladder, std::span<const double> volts);

/// Static voltages of an electrode with several numbers of modes, under the bias of the other drives (bias_of()) [V].
struct VoltagesByModes {
  /// Voltages by number of modes; `pulled_through` is the collapse voltage; without values if the switch has no contact.
  ByModes static_pull_in, release, pulled_through;
};
/// Returns the pull-in, release and collapse voltages of an electrode. The argument `pulled_through` is the known collapse
/// voltage of the scene's own switch, NaN without one; the collapse voltages with more modes are computed.
[[nodiscard]] VoltagesByModes voltages_by_modes(const ModeLadder& ladder, const Scene& scene, std::size_t electrode,
                                                double pulled_through);
[[nodiscard]] ByModes static_pull_in_by_modes(const ModeLadder& ladder, const Scene& scene, std::size_t electrode);
/// Returns the collapse voltage pull_through_voltage() with several numbers of modes [V]. The argument `own` is the collapse
/// voltage of the scene's switch, NaN if it has none.
[[nodiscard]] ByModes pulled_through_by_modes(const ModeLadder& ladder, std::size_t electrode, std::vector<double> volts,
                                              double own);

/// Returns the capacitance of the electrode that closes the switch, in the closed state under these drive voltages [F], for a
/// switch that closes onto a dielectric. If more modes change the capacitance by at least mode_shift_worth_telling, it is also
/// computed with Structure::most_modes, the largest number of modes of a closing.
[[nodiscard]] ByModes closed_capacitance_by_modes(const ModeLadder& ladder, std::span<const double> volts);
/// Returns the smallest computed number of modes from which on values stay within mode_shift_worth_telling of the limit. None
/// if the value with the most modes differs by more, or if the values do not converge.
[[nodiscard]] std::optional<int> modes_needed(const ByModes& found);

/// Returns the change of a voltage or other value by more modes as text, with the limit if the change is reported: "−6.1 %, to
/// 142.7 V".
[[nodiscard]] std::string shift_prose(const ByModes& value, std::string_view unit = "V");

/// Returns warnings about changes by more modes in the static pull-in voltages and in the capacitance of the closed state.
[[nodiscard]] std::vector<std::string> mode_warnings(const PreparedScene& prepared);

}  // namespace softland
