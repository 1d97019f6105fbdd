// Verb `new`: prints commented scenes to start from. Each works with the verbs `check`, `simulate`, `optimize`, `robustness`.
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/exit_status.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/read_file.h"
#include "base/require.h"

namespace softland::apps {
namespace {

struct StarterScene {
  std::string_view name, scene;  // name by which the user requests the scene; file of this shipped scene
};
constexpr std::array starter_scenes{StarterScene{"cantilever", "mem-gold.toml"},
                                    StarterScene{"cantilever-pzt", "mem-gold-pzt.toml"},
                                    StarterScene{"hinged-plate", "new/hinged-plate.toml"},
                                    StarterScene{"clamped-clamped", "new/clamped-clamped.toml"},
                                    StarterScene{"plate", "new/plate.toml"},
                                    StarterScene{"two-contacts", "new/two-contacts.toml"},
                                    StarterScene{"two-electrodes", "two-electrodes.toml"},
                                    StarterScene{"capacitive-bridge", "new/capacitive-bridge.toml"},
                                    StarterScene{"nem-cantilever", "nem-tin.toml"},
                                    StarterScene{"nem-casimir", "new/nem-casimir.toml"}};

std::string names_of_starter_scenes() {
  std::vector<std::string_view> names;
  for (const StarterScene& kind : starter_scenes) names.push_back(kind.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

int new_verb(const std::string& name) {
  const auto found = std::ranges::find(starter_scenes, name, &StarterScene::name);
  require(found != starter_scenes.end(), fmt::format("new {}: must be one of {}", name, names_of_starter_scenes()));
  print(read_file(shipped_scene(std::string(found->scene))));
  return exit_done;
}

}  // namespace

void add_new(Verb& verb) {
  const auto kind = std::make_shared<std::string>(starter_scenes.front().name);
  verb.positional("KIND", *kind, names_of_starter_scenes() + "; default: the first", false);
  verb.footer("Example:\n  softland new cantilever > my-switch.toml");
  verb.runs([kind](const Common&) { return new_verb(*kind); });
}

}  // namespace softland::apps
