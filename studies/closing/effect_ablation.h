// What a scene could do without: each effect that it describes is left out in turn, and the closing is run again under the same
// voltages. `effects = "auto"` in [simulate] leaves out what does not matter.
#pragma once

#include <algorithm>
#include <limits>
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

/// A closing that ends in the window, or earlier where it costs too much.
struct BoundedClosing {
  Metrics metrics;
  long steps = 0;
  double seconds = 0;              ///< of its thread's processor [s]
  std::optional<double> end = {};  ///< where its bound ended it [s]; none: it ran to the end of the window
  std::vector<std::string> warnings = {};
  std::vector<double> states = {};  ///< those that a right-hand side is timed at, see timing.h
};

/// What a closing without an effect may cost. A switch that loses what stops its rebounds, such as the film over a rigid face,
/// may take a thousand times as many steps as with it, and a law with states of its own a hundred times as long for each.
struct ClosingBound {
  static constexpr long fewest_steps = 100'000, steps_over_own = 10;
  static constexpr double least_seconds = 10, seconds_over_own = 100;

  long steps = std::numeric_limits<long>::max();
  double seconds = std::numeric_limits<double>::infinity();  ///< [s]
  /// The bound that follows from the scene's own closing.
  [[nodiscard]] static ClosingBound after(const BoundedClosing& own) {
    return {.steps = std::max(fewest_steps, steps_over_own * own.steps),
            .seconds = std::max(least_seconds, seconds_over_own * own.seconds)};
  }
};
/// `what`, `done` and `share` are those of progress.
[[nodiscard]] BoundedClosing bounded_closing(const PreparedScene& prepared, const Switch& model, const ClosingBound& bound,
                                             const Watch& watch, const std::string& what, double done = 0, double share = 1);

/// The scene without one effect.
struct EffectAblation {
  OmissibleEffect what;
  Metrics metrics;
  double influence = 0;            ///< see influence()
  double rhs_seconds = 0;          ///< per right-hand side [s]; NaN where not asked for
  std::optional<double> end = {};  ///< see BoundedClosing
};

/// Everything the scene describes that it could do without, in the order of its sections. Drives are not effects: what a waveform
/// drives stays.
[[nodiscard]] std::vector<OmissibleEffect> omissible_effects(const PreparedScene& prepared);

/// The scene without these effects, its waveforms in volts.
[[nodiscard]] PreparedScene without(const PreparedScene& prepared, const std::vector<OmissibleEffect>& effects);

/// Largest relative difference of t_i, v_i and B_H as they are counted. Infinite where one of them appears or disappears, and
/// where neither closing touches.
[[nodiscard]] double influence(const Metrics& own, const Metrics& other, const MetricsOptions& options);

/// Leaves out one effect after the other; asked to stop, the list ends with the last closing that was complete. No closing costs
/// more than the bound after `own`. `timed`: also measures the right-hand side.
[[nodiscard]] std::vector<EffectAblation> ablate_effects(const PreparedScene& prepared, const BoundedClosing& own, bool timed,
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

/// Effects whose influence is at most `tolerance`, alone and together, and without which the closing ran to its end: while
/// together they exceed it the most influential one is put back. Nothing is left out of a scene whose closing does not touch.
/// Throws Interrupted where `watch` asks to stop.
[[nodiscard]] EffectsChoice negligible_effects(const PreparedScene& prepared, double tolerance, const Watch& watch = {});

}  // namespace softland
