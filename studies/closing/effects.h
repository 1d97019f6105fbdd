// Compares the effect and the cost of laws in a scene. The closing of the scene is repeated without each effect in turn, and
// with each other gas law. The voltages stay the same, so that only the law of the omitted or replaced effect differs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "objectives/figures.h"
#include "studies/closing/effect_ablation.h"
#include "studies/closing/prepared.h"

namespace softland {

/// The results of a scene's closing with one law of an effect (gas, contact, dispersion ...) in place of the scene's own law.
struct Effect {
  std::string section;    ///< section of the scene that describes the law: "gas"
  std::string choice;     ///< name of the law; "none" if the physical effect is left out
  bool in_scene = false;  ///< true for the law of the scene itself
  NamedNumber magnitude;
  NamedNumber group;  ///< the dimensionless group that decides whether the law is valid
  Metrics metrics;    ///< figures of the closing with this law
  /// Computing time per evaluation of the right-hand side of the equations of motion along this closing [s].
  double rhs_seconds = 0;
  std::vector<std::string> warnings;  ///< warnings of the closing with this law
  std::optional<double> end =
      {};  ///< time at which the bound on the cost ended the closing [s] (BoundedClosing); none for the scene's own closing
};

/// A law that cannot replace the law of the scene in the comparison.
struct NotCompared {
  std::string choice;
  std::string reason;
};

struct Effects {
  std::vector<Effect> list;               ///< results of the closing with each gas law
  std::vector<NotCompared> not_compared;  ///< gas laws that are impossible for the scene
  std::vector<EffectAblation> ablations;
  double window = 0;  ///< simulated time of every closing [s]
  /// True if interrupted: `list` and `not_compared` then hold complete closings only, at least the scene's own.
  bool interrupted = false;

  /// Returns the results of the scene's own law in a section of the scene, such as "gas".
  [[nodiscard]] const Effect& own(const std::string& section) const;
  /// Returns the largest less the smallest value of a figure over the laws of a section, except "none", divided by the figure
  /// of the scene's own closing. NaN if the figure is missing in any of the compared closings.
  [[nodiscard]] double spread(const std::string& section, const Figure& figure) const;
};

/// Repeats the closing without each effect, without gas, and with every gas law.
/// - The gas has the state that the scene describes (air at 101325 Pa and 300 K by default). Keys of other gas laws are
///   removed.
/// - The linear damper and the film over a slit are compared only if the scene describes them.
/// - The cost of the scene's own closing bounds that of the other closings (ClosingBound).
/// Throws Interrupted if `progress` asks to stop before the scene's own closing is complete.
[[nodiscard]] Effects compare_effects(const PreparedScene& prepared, const Progress& progress = {});

}  // namespace softland
