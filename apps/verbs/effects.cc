// Which effects matter in a scene.
#include "studies/closing/effects.h"

#include <optional>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/verbs/verbs.h"
#include "reports/effects_report.h"
#include "studies/closing/auto_settings.h"

namespace softland::apps {
namespace {

int effects_verb(const Common& c) {
  const SceneFile file = load_scene_or_result(c);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const PreparedScene p = prepare_and_choose(file, false, work->watch());
  static_cast<void>(claim_places(c, {}));
  const Effects effects = compare_effects(p, work->watch());
  work.reset();
  print_json_or(c, effects_json(p, effects, {.command = c.command}), effects_text(effects));
  return effects.interrupted ? exit_interrupted : exit_status_of(effects.own("gas").metrics.status);
}

}  // namespace

void add_effects(Verb& verb) {
  verb.with_scene(true, true);
  verb.with_json();
  verb.footer("Example:\n  softland effects scenes/mem-gold.toml --set gas.pressure=\"1 kPa\"");
  verb.runs(effects_verb);
}

}  // namespace softland::apps
