// Finds the effects that a scene can omit. Each described effect is left out in turn, and the closing is simulated again under
// the same voltages. `effects = "auto"` in [simulate] leaves out the effects that hardly change the figures.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "objectives/figures.h"
#include "studies/closing/prepared.h"

namespace softland {

/// A number with its name and unit, such as "damping per length, closed" in "N s/m^2".
struct NamedNumber {
  std::string name;
  std::string unit;  ///< unit of the number, such as "N s/m^2"; empty: dimensionless
  double value = Metrics::unset;
};

/// A physical effect, described by a key or section of a scene, that a model can leave out.
struct OmissibleEffect {
  std::string effect;       ///< key path of the effect in a scene: "gas", "electrode.main.fringing"
  std::string choice = {};  ///< value of the effect's key in the scene: "strip", "meijs-fokkema"
  NamedNumber magnitude;
  NamedNumber group;  ///< the dimensionless group that measures the size of the physical effect
  /// Value of the effect's key in a scene without the effect; none if the key or section is removed.
  std::optional<SceneValue> instead;
  bool automatic = true;  ///< true if effects = "auto" may leave out this effect
};

/// The results of a closing that ends with the simulated time, or earlier if its cost exceeds a bound.
struct BoundedClosing {
  Metrics metrics;
  long steps = 0;
  double seconds = 0;  ///< processor time of the thread that ran the closing [s]
  /// Time at which the bound on the cost ended the closing [s]; none if the closing ran to the end of the simulated time.
  std::optional<double> end = {};
  std::vector<std::string> warnings = {};
  std::vector<double> states = {};  ///< states of the closing at which a right-hand side is timed (timing.h)
};

/// The largest cost of a closing without one effect. Without the effect that stops the rebounds, such as the gas film over a
/// rigid plate, a closing takes up to a thousand times as many steps. A law with further state variables takes up to a hundred
/// times as long per step.
struct ClosingBound {
  static constexpr long fewest_steps = 100'000, steps_over_own = 10;
  static constexpr double least_seconds = 10, seconds_over_own = 100;

  long steps = std::numeric_limits<long>::max();
  double seconds = std::numeric_limits<double>::infinity();  ///< largest processor time of the closing [s]
  /// Returns the bound on the cost of other closings, computed from the cost of the scene's own closing.
  [[nodiscard]] static ClosingBound after(const BoundedClosing& own) {
    return {.steps = std::max(fewest_steps, steps_over_own * own.steps),
            .seconds = std::max(least_seconds, seconds_over_own * own.seconds)};
  }
};
/// Runs a closing within a bound on its cost. `what` names the closing in progress reports. The closing is the `share` of a
/// computation of which `done` is complete.
[[nodiscard]] BoundedClosing bounded_closing(const PreparedScene& prepared, const Switch& model, const ClosingBound& bound,
                                             const Progress& progress, const std::string& what, double done = 0,
                                             double share = 1);

/// The results of the scene's closing without one physical effect.
struct EffectAblation {
  OmissibleEffect what;
  Metrics metrics;
  double influence = 0;  ///< largest relative change of a figure without the effect: see the function influence()
  /// Computing time per evaluation of the right-hand side of the equations of motion [s]; NaN if not measured.
  double rhs_seconds = 0;
  /// Time at which the bound on the cost ended the closing [s]; none if the closing ran to the end of the simulated time.
  std::optional<double> end = {};
};

/// Returns all described effects that the scene could omit, in the order of the scene's sections. Drives with a waveform do not
/// count as effects.
[[nodiscard]] std::vector<OmissibleEffect> omissible_effects(const PreparedScene& prepared);

/// Returns the scene without these effects. Its waveforms have the same voltages in volts, although its pull-in voltages may
/// differ.
[[nodiscard]] PreparedScene copy_without(const PreparedScene& prepared, const std::vector<OmissibleEffect>& effects);

/// Returns the largest relative difference between two closings of initial contact time t_i, impact velocity v_i and highest
/// rebound B_H; rebounds below the significant height count as equal (Figure::counted()). Infinite if a figure exists in one
/// closing only, and if the scene's own closing reaches no contact.
[[nodiscard]] double influence(const Metrics& own, const Metrics& other, const MetricsOptions& options);

/// Simulates the closing without each of the effects in turn. If `progress` asks to stop, the list ends with the last complete
/// closing. No closing costs more than the bound that follows from `own`, the scene's own closing. `timed` also measures the
/// time per evaluation of the right-hand side.
[[nodiscard]] std::vector<EffectAblation> ablate_effects(const PreparedScene& prepared, const BoundedClosing& own, bool timed,
                                                         const Progress& progress = {});

/// The physical effects that effects = "auto" leaves out.
struct EffectsChoice {
  std::vector<EffectAblation> left_out;
  double influence = 0;  ///< largest relative change of a figure when all left-out effects are omitted together
};

struct DescribedEffects {
  Scene described;  ///< scene with every effect, and its drive waveforms as in the file
  EffectsChoice choice;
};

/// Returns the effects that the scene can omit. Each effect alone, and all together, have an influence of at most `tolerance`,
/// and the closing without each effect is complete. While the effects together exceed the tolerance, the most influential one
/// is restored. No effect is left out of a scene whose closing reaches no contact. Throws Interrupted if `progress` asks to
/// stop.
[[nodiscard]] EffectsChoice negligible_effects(const PreparedScene& prepared, double tolerance, const Progress& progress = {});

}  // namespace softland
