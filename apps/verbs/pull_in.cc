// Pull-in voltages of every electrode.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/pull_in_words.h"
#include "apps/scenes.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "studies/choices.h"

namespace softland::apps {
namespace {

int pull_in_verb(const Common& c) {
  const SceneFile file = load_scene(c);
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const Prepared prepared = prepare_and_choose(file, false, work->watch());
  static_cast<void>(claim_places(c, {}));
  const auto& electrodes = prepared.scene.device.electrodes;
  require(!electrodes.empty(), fmt::format("{}: there is no electrode to pull in", c.scene));
  nlohmann::json all = nlohmann::json::object();
  std::string text;
  bool failed = false, none = false;
  for (std::size_t k = 0; k < electrodes.size() && !work->watch().stopped(); ++k) {
    nlohmann::json one = pull_in_of(prepared, k, work->watch());
    const nlohmann::json& p = one["pull_in"];
    if (!pulls_in(prepared.scene.device, k)) {
      text += fmt::format("electrode {}\n  on the far side: pulls away from the contact\n", electrodes[k].name);
      if (electrodes.size() > 1) all[electrodes[k].name] = std::move(one);
      continue;
    }
    text += fmt::format("electrode {}\n", electrodes[k].name);
    if (one["status"] == to_string(Status::no_contact)) {
      text += "  pulls away from the contact where the switch rests: no pull-in voltage\n";
      none = true;
      if (electrodes.size() > 1) {
        all[electrodes[k].name] = std::move(one);
      } else {
        all = std::move(one);
      }
      continue;
    }
    text += collapsed(one)
                ? fmt::format("  {}\n", no_open_state)
                : fmt::format("  static pull-in   {} ({})\n  dynamic pull-in  {}\n", volts(p["static_V"]),
                              p["static_kind"].get<std::string>() == "fold" ? "fold of the static branch"
                                                                            : "the contact point reaches the contact first",
                              dynamic_words(p));
    if (prepared.model.has_contact()) text += fmt::format("  release          {}\n", volts(p["release_V"]));
    if (collapsed(one))
      none = true;
    else
      failed = failed || one["status"] != "done";
    if (electrodes.size() == 1) {
      all = std::move(one);
    } else {
      all[electrodes[k].name] = std::move(one);
    }
  }
  const bool interrupted = work->watch().stopped();
  work.reset();
  print_json_or(c, all, text);
  return interrupted ? exit_interrupted : failed ? exit_numerical_failure : none ? exit_no_success : exit_done;
}

}  // namespace

void add_pull_in(Verb& verb) {
  verb.with_scene();
  verb.with_json();
  verb.footer("Example:\n  softland pull-in scenes/mem-gold.toml --set structure.thickness=\"2.1 um\"");
  verb.runs(pull_in_verb);
}

}  // namespace softland::apps
