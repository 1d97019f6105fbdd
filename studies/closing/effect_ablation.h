// The effects that a scene can do without: each described effect is left out in turn, and the closing is run again under the
// same voltages. `effects = "auto"` in [simulate] leaves out those that do not matter.
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

/// A number for comparison: "damping per length, closed", "N s/m^2".
struct NamedNumber {
  std::string name;
  std::string unit;  ///< empty: dimensionless
  double value = Metrics::unset;
};

/// A part of a scene that can be left out.
struct OmissibleEffect {
  std::string effect;       ///< key path: "gas", "electrode.main.fringing"
  std::string choice = {};  ///< value in the scene: "strip", "meijs-fokkema"
  NamedNumber magnitude;
  NamedNumber group;  ///< the dimensionless group that measures its size
  /// Value of the key in a scene without the effect; none: the key or section is removed.
  std::optional<SceneValue> instead;
  bool automatic = true;  ///< true if effects = "auto" may leave it out
};

/// A closing that ends in the window, or earlier if it costs too much.
struct BoundedClosing {
  Metrics metrics;
  long steps = 0;
  double seconds = 0;              ///< processor time of its thread [s]
  std::optional<double> end = {};  ///< time at which its bound ended it [s]; none: it ran to the end of the window
  std::vector<std::string> warnings = {};
  std::vector<double> states = {};  ///< states at which a right-hand side is timed, see timing.h
};

/// The largest cost of a closing without an effect. A switch may lose the effect that stops its rebounds, such as the film over
/// a rigid face. It then takes up to a thousand times as many steps, and with a law with states of its own up to a hundred
/// times as long per step.
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
/// Runs a closing within a bound; `what`, `done` and `share` are those of progress.
[[nodiscard]] BoundedClosing bounded_closing(const PreparedScene& prepared, const Switch& model, const ClosingBound& bound,
                                             const Watch& watch, const std::string& what, double done = 0, double share = 1);

/// The scene without one effect.
struct EffectAblation {
  OmissibleEffect what;
  Metrics metrics;
  double influence = 0;            ///< see influence()
  double rhs_seconds = 0;          ///< per right-hand side [s]; NaN if not measured
  std::optional<double> end = {};  ///< see BoundedClosing
};

/// Returns all described parts that the scene could do without, in the order of its sections. Drives are not effects: the
/// drives of waveforms stay.
[[nodiscard]] std::vector<OmissibleEffect> omissible_effects(const PreparedScene& prepared);

/// Returns the scene without these effects, its waveforms in volts.
[[nodiscard]] PreparedScene without(const PreparedScene& prepared, const std::vector<OmissibleEffect>& effects);

/// Largest relative difference of t_i, v_i and B_H as they are counted. Infinite if one of them appears or disappears, and if
/// neither closing touches.
[[nodiscard]] double influence(const Metrics& own, const Metrics& other, const MetricsOptions& options);

/// Leaves out one effect after the other. After a stop, the list ends with the last complete closing. No closing costs more
/// than the bound after `own`. `timed` also measures the right-hand side.
[[nodiscard]] std::vector<EffectAblation> ablate_effects(const PreparedScene& prepared, const BoundedClosing& own, bool timed,
                                                         const Watch& watch = {});

/// The choice of effects = "auto".
struct EffectsChoice {
  std::vector<EffectAblation> left_out;
  double influence = 0;  ///< influence of all of them together
};

struct DescribedEffects {
  Scene described;  ///< scene with every effect, its drives as written
  EffectsChoice choice;
};

/// Returns the effects whose influence is at most `tolerance`, alone and together, and without which the closing ran to its
/// end. If they exceed it together, the most influential one is put back, again and again. Nothing is left out of a scene whose
/// closing does not touch. Throws Interrupted if `watch` asks to stop.
[[nodiscard]] EffectsChoice negligible_effects(const PreparedScene& prepared, double tolerance, const Watch& watch = {});

}  // namespace softland
