// Verb `effects`: compares the closing with and without each effect of the model.
#include "studies/closing/effects.h"

#include "reports/effects_report.h"
#include "verbs/study.h"

namespace softland::verbs {
namespace {

Outcome shown(const EffectsRecord& record) { return {.json = json_of(record), .text = text_of(record)}; }

struct EffectsRequest : Usual {
  static constexpr bool is_explorable = true;
  static constexpr auto name = "effects",
                        about = "show which effects of the model matter in a scene, by how much, and their computing time",
                        python = "effects",
                        remarks = "Example:\n  softland effects scenes/mem-gold.toml --set gas.pressure=\"1 kPa\"";
  static Outcome shown_again(const nlohmann::json& json) { return shown(read_effects(json)); }
};

template <class Archive>
void options(Archive&, EffectsRequest&) {}

Outcome run(const Setting& setting, const EffectsRequest&) {
  const auto scene = setting.prepared(false);
  const EffectsRecord record{.origin = origin_of("effects", *scene, setting.command),
                             .found = compare_effects(*scene, setting.progress)};
  Outcome outcome = shown(record);
  outcome.ending = record.found.interrupted ? Ending::interrupted : ending_of(record.found.own("gas").metrics.status);
  return outcome;
}

}  // namespace

Study effects_study() { return study_of<EffectsRequest>(); }

}  // namespace softland::verbs
