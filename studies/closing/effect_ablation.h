// What a scene could do without: each effect that it describes is left out in turn, and the closing is run again under the same
// voltages. `effects = "auto"` in [simulate] leaves out what does not matter.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/watch.h"
#include "objectives/figures.h"
#include "studies/closing/prepared.h"

namespace softland {

/// A number that people compare: "damping per length, closed", "N s/m^2".
struct NamedNumber {
  std::string name;
  std::string unit;  ///< empty: dimensionless
  double value = Metrics::unset;
};

/// A part of a scene that can be left out.
struct OmissibleEffect {
  std::string effect;       ///< key path: "gas", "electrode.main.fringing"
  std::string choice = {};  ///< what the scene says there: "strip", "meijs-fokkema"
  NamedNumber magnitude;
  NamedNumber group;  ///< the dimensionless group that says how large it is
  /// What the key becomes in a scene without the effect; nothing: key or section disappears.
  std::optional<SceneValue> instead;
  bool automatic = true;  ///< whether effects = "auto" may leave it out
};

/// The scene without one effect.
struct EffectAblation {
  OmissibleEffect what;
  Metrics metrics;
  double influence = 0;    ///< see influence()
  double rhs_seconds = 0;  ///< per right-hand side [s]; NaN where not asked for
};

/// Everything the scene describes that it could do without, in the order of its sections. Drives are not effects: what a waveform
/// drives stays.
[[nodiscard]] std::vector<OmissibleEffect> omissible_effects(const PreparedScene& prepared);

/// The scene without these effects, its waveforms in volts.
[[nodiscard]] PreparedScene without(const PreparedScene& prepared, const std::vector<OmissibleEffect>& effects);

/// Largest relative difference of t_i, v_i and B_H as they are counted. Infinite where one of them appears or disappears, and
/// where neither closing touches.
[[nodiscard]] double influence(const Metrics& own, const Metrics& other, const MetricsOptions& options);

/// Leaves out one effect after the other; asked to stop, the list ends with the last closing that was complete. `timed`: also
/// measures the right-hand side.
[[nodiscard]] std::vector<EffectAblation> ablate_effects(const PreparedScene& prepared, const Metrics& own, bool timed,
                                                         const Watch& watch = {});

/// What effects = "auto" decided.
struct EffectsChoice {
  std::vector<EffectAblation> left_out;
  double influence = 0;  ///< of all of them together
};

struct DescribedEffects {
  Scene described;  ///< with every effect, its drives as written
  EffectsChoice choice;
};

/// Effects whose influence is at most `tolerance`, alone and together: while together they exceed it the most influential one is
/// put back. Nothing is left out of a scene whose closing does not touch. Throws Interrupted where `watch` asks to stop.
[[nodiscard]] EffectsChoice negligible_effects(const PreparedScene& prepared, double tolerance, const Watch& watch = {});

}  // namespace softland
