// Verb `effects`: a closing with and without each effect.
#include "studies/closing/effects.h"

#include "reports/effects_report.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

struct EffectsRequest : Usual {
  static constexpr bool is_explorable = true;
  static constexpr auto name = "effects", about = "which effects matter in a scene, by how much, and what each costs",
                        python = "effects",
                        remarks = "Example:\n  softland effects scenes/mem-gold.toml --set gas.pressure=\"1 kPa\"";
};

template <class Archive>
void options(Archive&, EffectsRequest&) {}

Outcome run(const Setting& setting, const EffectsRequest&) {
  const auto scene = setting.prepared(false);
  const Effects found = compare_effects(*scene, setting.watch);
  return {.json = effects_json(*scene, found, {.command = setting.command}),
          .text = effects_text(found),
          .ending = found.interrupted ? Ending::interrupted : ending_of(found.own("gas").metrics.status)};
}

}  // namespace

Study effects_study() { return study_of<EffectsRequest>(); }

}  // namespace softland::verbs
