// Scenes to start from: each can be checked, simulated, searched and judged on devices that differ.
#include <fmt/format.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/read_file.h"
#include "base/require.h"

namespace softland::apps {
namespace {

int new_verb(const std::string& kind) {
  const std::map<std::string, std::string> scenes{{"cantilever", "mem-gold.toml"},
                                                  {"cantilever-pzt", "mem-gold-pzt.toml"},
                                                  {"clamped-clamped", "new/clamped-clamped.toml"},
                                                  {"hinged-plate", "new/hinged-plate.toml"},
                                                  {"plate", "new/plate.toml"},
                                                  {"nem-cantilever", "nem-tin.toml"},
                                                  {"nem-casimir", "new/nem-casimir.toml"},
                                                  {"two-contacts", "new/two-contacts.toml"},
                                                  {"two-electrodes", "two-electrodes.toml"}};
  const auto found = scenes.find(kind);
  std::vector<std::string> kinds;
  for (const auto& [name, scene] : scenes) kinds.push_back(name);
  require(found != scenes.end(), fmt::format("new {}: must be one of {}", kind, fmt::join(kinds, ", ")));
  print(read_file(shipped_scene(found->second)));
  return exit_done;
}

}  // namespace

void add_new(Verb& verb) {
  const auto kind = std::make_shared<std::string>("cantilever");
  verb.positional("KIND", *kind,
                  "cantilever (default), cantilever-pzt, hinged-plate, clamped-clamped, plate, two-contacts, two-electrodes, "
                  "nem-cantilever or nem-casimir",
                  false);
  verb.footer("Example:\n  softland new cantilever > my-switch.toml");
  verb.runs([kind](const Common&) { return new_verb(*kind); });
}

}  // namespace softland::apps
