// Which laws matter in a scene, by how much, and what they cost: the closing of the scene repeated with each of them in turn.
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
  std::string section;    ///< of the scene: "gas"
  std::string choice;     ///< the law, "none" where the effect is left out
  bool in_scene = false;  ///< what the scene itself says
  NamedNumber magnitude;
  NamedNumber group;                  ///< the dimensionless group that decides whether the law holds
  Metrics metrics;                    ///< of this closing
  double rhs_seconds = 0;             ///< per right-hand side, along this closing [s]
  std::vector<std::string> warnings;  ///< of this closing
  std::optional<double> end = {};     ///< see BoundedClosing; the scene's own closing runs to the end of the window
};

/// A law that cannot take the place of the scene's own.
struct NotCompared {
  std::string choice;
  std::string reason;
};

struct Effects {
  std::vector<Effect> list;               ///< the laws of the gas
  std::vector<NotCompared> not_compared;  ///< those that the scene cannot have
  std::vector<EffectAblation> omissions;
  double window = 0;         ///< of every closing [s]
  bool interrupted = false;  ///< asked to stop: the lists hold only what was complete by then, the scene's own closing at least

  /// What the scene itself says in this section.
  [[nodiscard]] const Effect& own(const std::string& section) const;
  /// Largest less smallest value of a figure over the laws of a section that are films or dampers, not "none"; relative to the
  /// scene's own closing. NaN when it is missing in any of them.
  [[nodiscard]] double spread(const std::string& section, const Figure& figure) const;
};

/// Repeats the closing without each effect, and with no gas and with every gas law, in the state of gas that the scene describes
/// (air at 101325 Pa and 300 K where it describes none), each law without what only others are given. The linear damper and the
/// film over a slit only where the scene describes them. No closing but the scene's own costs more than the bound after that
/// (ClosingBound). Throws Interrupted where `watch` asks to stop before the scene's own closing is complete.
[[nodiscard]] Effects compare_effects(const PreparedScene& prepared, const Watch& watch = {});

}  // namespace softland
