// Compares laws in a scene, by their effect and their cost: the closing of the scene is repeated with each of them in turn.
// Every effect is left out in turn, and every gas law takes the place of the scene's own. Drives keep their volts, so that only
// the law differs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/watch.h"
#include "objectives/figures.h"
#include "studies/closing/effect_ablation.h"
#include "studies/closing/prepared.h"

namespace softland {

/// The scene with one law in the place of its own.
struct Effect {
  std::string section;    ///< section of the scene: "gas"
  std::string choice;     ///< the law; "none" if the effect is left out
  bool in_scene = false;  ///< true for the law of the scene itself
  NamedNumber magnitude;
  NamedNumber group;                  ///< the dimensionless group that decides if the law holds
  Metrics metrics;                    ///< figures of this closing
  double rhs_seconds = 0;             ///< time of a right-hand side, along this closing [s]
  std::vector<std::string> warnings;  ///< warnings of this closing
  std::optional<double> end = {};     ///< see BoundedClosing; the scene's own closing runs to the end of the window
};

/// A law that cannot take the place of the scene's own.
struct NotCompared {
  std::string choice;
  std::string reason;
};

struct Effects {
  std::vector<Effect> list;               ///< the laws of the gas
  std::vector<NotCompared> not_compared;  ///< the laws that the scene cannot have
  std::vector<EffectAblation> omissions;
  double window = 0;         ///< window of every closing [s]
  bool interrupted = false;  ///< true after a stop: the lists hold only complete closings, the scene's own at least

  /// The entry of the scene's own law in this section.
  [[nodiscard]] const Effect& own(const std::string& section) const;
  /// Largest less smallest value of a figure over the laws of a section that are films or dampers, not "none"; relative to the
  /// scene's own closing. NaN if it is missing in any of them.
  [[nodiscard]] double spread(const std::string& section, const Figure& figure) const;
};

/// Repeats the closing without each effect, and with no gas and with every gas law. The gas has the state that the scene
/// describes (air at 101325 Pa and 300 K by default), and each law is without the keys of the others. The linear damper and the
/// film over a slit are compared only if the scene describes them. No closing but the scene's own costs more than the bound
/// after that (ClosingBound). Throws Interrupted if `watch` asks to stop before the scene's own closing is complete.
[[nodiscard]] Effects compare_effects(const PreparedScene& prepared, const Watch& watch = {});

}  // namespace softland
