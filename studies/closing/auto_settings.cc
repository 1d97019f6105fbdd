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

PreparedScene with_as_many_modes_as_needed(const PreparedScene& prepared, bool default_limits, const Watch& watch) {
  const AutoModes chosen = choose_modes(prepared.scene.file, watch);
  SceneFile file = prepared.scene.file;
  file.assign("structure.modes", chosen.modes);
  PreparedScene p = prepare(file, default_limits, watch);
  p.scene.warnings.push_back(chosen.note());
  return p;
}

PreparedScene without_what_does_not_matter(const PreparedScene& prepared, const Watch& watch) {
  const double tolerance = prepared.scene.simulate.effects_tolerance;
  EffectsChoice choice = negligible_effects(prepared, tolerance, watch);
  std::vector<OmissibleEffect> effects;
  for (const EffectAblation& o : choice.left_out) effects.push_back(o.what);
  PreparedScene chosen = without(prepared, effects);
  chosen.scene.warnings.push_back(left_out_note(choice, tolerance));
  chosen.effects =
      std::make_shared<const DescribedEffects>(DescribedEffects{.described = prepared.scene, .choice = std::move(choice)});
  return chosen;
}

}  // namespace

PreparedScene choose(PreparedScene prepared, bool default_limits, const Watch& watch) {
  if (prepared.scene.auto_modes) prepared = with_as_many_modes_as_needed(prepared, default_limits, watch);
  if (prepared.scene.simulate.automatic_effects) prepared = without_what_does_not_matter(prepared, watch);
  return prepared;
}

PreparedScene prepare_and_choose(const SceneFile& file, bool default_limits, const Watch& watch) {
  PreparedScene prepared = choose(prepare(file, default_limits, watch), default_limits, watch);
  for (std::string& warning : mode_warnings(prepared)) prepared.scene.warnings.push_back(std::move(warning));
  return prepared;
}

}  // namespace softland
