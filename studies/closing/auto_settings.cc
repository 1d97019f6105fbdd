#include "studies/closing/auto_settings.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "studies/closing/auto_modes.h"
#include "studies/closing/by_modes.h"
#include "studies/closing/effect_ablation.h"

namespace softland {
namespace {

std::string left_out_note(const EffectsChoice& choice, double tolerance) {
  if (choice.left_out.empty())
    return fmt::format(
        "effects = \"auto\": nothing is left out: no effect was found that changes t_i, v_i and B_H by less than {}",
        engineering(tolerance, ""));
  std::vector<std::string> names;
  for (const EffectAblation& o : choice.left_out)
    names.push_back(fmt::format("{} ({})", o.what.effect, engineering(o.influence, "", 1)));
  return fmt::format("effects = \"auto\" leaves out {}: t_i, v_i and B_H change by {} together", fmt::join(names, ", "),
                     engineering(choice.influence, "", 1));
}

PreparedScene with_as_many_modes_as_needed(const PreparedScene& prepared, bool default_limits, const Progress& progress) {
  const AutoModes chosen = choose_modes(prepared.scene.file, progress);
  SceneFile file = prepared.scene.file;
  file.assign("structure.modes", chosen.modes);
  PreparedScene p = prepare(file, default_limits, progress);
  p.scene.warnings.push_back(chosen.note());
  return p;
}

PreparedScene without_what_does_not_matter(const PreparedScene& prepared, const Progress& progress) {
  const double tolerance = prepared.scene.simulate.effects_tolerance;
  EffectsChoice choice = negligible_effects(prepared, tolerance, progress);
  std::vector<OmissibleEffect> effects;
  for (const EffectAblation& o : choice.left_out) effects.push_back(o.what);
  PreparedScene chosen = copy_without(prepared, effects);
  chosen.scene.warnings.push_back(left_out_note(choice, tolerance));
  chosen.effects =
      std::make_shared<const DescribedEffects>(DescribedEffects{.described = prepared.scene, .choice = std::move(choice)});
  return chosen;
}

}  // namespace

PreparedScene choose(PreparedScene prepared, bool default_limits, const Progress& progress) {
  if (prepared.scene.auto_modes) prepared = with_as_many_modes_as_needed(prepared, default_limits, progress);
  if (prepared.scene.simulate.automatic_effects) prepared = without_what_does_not_matter(prepared, progress);
  return prepared;
}

PreparedScene prepare_and_choose(const SceneFile& file, bool default_limits, const Progress& progress) {
  PreparedScene prepared = choose(prepare(file, default_limits, progress), default_limits, progress);
  for (std::string& warning : mode_warnings(prepared)) prepared.scene.warnings.push_back(std::move(warning));
  return prepared;
}

}  // namespace softland
