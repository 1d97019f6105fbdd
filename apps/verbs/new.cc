// Verb `new`: prints commented scenes to start from. Each has all that `check`, `simulate`, `optimize` and `robustness` need.
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

struct Kind {
  std::string_view name, scene;  // name; shipped scene
};
constexpr std::array kinds{Kind{"cantilever", "mem-gold.toml"},
                           Kind{"cantilever-pzt", "mem-gold-pzt.toml"},
                           Kind{"hinged-plate", "new/hinged-plate.toml"},
                           Kind{"clamped-clamped", "new/clamped-clamped.toml"},
                           Kind{"plate", "new/plate.toml"},
                           Kind{"two-contacts", "new/two-contacts.toml"},
                           Kind{"two-electrodes", "two-electrodes.toml"},
                           Kind{"capacitive-bridge", "new/capacitive-bridge.toml"},
                           Kind{"nem-cantilever", "nem-tin.toml"},
                           Kind{"nem-casimir", "new/nem-casimir.toml"}};

std::string names_of_kinds() {
  std::vector<std::string_view> names;
  for (const Kind& kind : kinds) names.push_back(kind.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

int new_verb(const std::string& name) {
  const auto found = std::ranges::find(kinds, name, &Kind::name);
  require(found != kinds.end(), fmt::format("new {}: must be one of {}", name, names_of_kinds()));
  print(read_file(shipped_scene(std::string(found->scene))));
  return exit_done;
}

}  // namespace

void add_new(Verb& verb) {
  const auto kind = std::make_shared<std::string>(kinds.front().name);
  verb.positional("KIND", *kind, names_of_kinds() + "; default: the first", false);
  verb.footer("Example:\n  softland new cantilever > my-switch.toml");
  verb.runs([kind](const Common&) { return new_verb(*kind); });
}

}  // namespace softland::apps
