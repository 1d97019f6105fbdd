// Natural frequencies.
#include <fmt/format.h>

#include <string>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/verbs/verbs.h"
#include "model/constants.h"
#include "reports/quantity.h"
#include "reports/text.h"
#include "studies/choices.h"

namespace softland::apps {
namespace {

using internal::quantity;

int modes_verb(const Common& c) {
  const SceneFile file = load_scene(c);
  const Prepared prepared = prepare_and_choose(file, false, WatchedWork(c.quiet, c.stop).watch());
  static_cast<void>(claim_places(c, {}));
  nlohmann::json list = nlohmann::json::array();
  constexpr int digits = 6;
  std::string text = "mode  angular frequency    frequency\n";
  for (const double omega : prepared.model.angular_frequencies()) {
    list.push_back(omega);
    text += fmt::format("{:>4}  {:>17}  {:>11}\n", list.size(), quantity(omega, "rad/s", digits),
                        quantity(omega / (2 * pi), "Hz", digits));
  }
  for (const std::string& w : prepared.scene.warnings) text += "\n" + wrapped("warning: " + w) + "\n";
  print_json_or(c, {{"natural_frequencies_rad_s", list}, {"warnings", prepared.scene.warnings}}, text);
  return exit_done;
}

}  // namespace

void add_modes(Verb& verb) {
  verb.with_scene();
  verb.with_json();
  verb.footer("Example:\n  softland modes scenes/mem-gold-pzt.toml --set structure.modes=8");
  verb.runs(modes_verb);
}

}  // namespace softland::apps
