#include "config/assumed_spread.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/structure/structure.h"

namespace softland {
namespace {

void vary(SceneFile& file, const std::string& key, std::string_view cov, bool always) {
  if (always || file.written(key)) file.set(fmt::format("spread.\"{}\"={{distribution=\"normal\",cov=\"{}\"}}", key, cov));
}

// Varies a key of [structure], such as thickness, by a normal factor with the coefficient of variation `cov`. The same factor
// multiplies the key in every beam section that has its own value.
void vary_sections(SceneFile& file, std::string_view key, std::string_view cov) {
  std::vector<std::string> keys;
  const auto add = [&](const std::string& path) {
    if (file.written(path)) keys.push_back('"' + path + '"');
  };
  add(fmt::format("structure.{}", key));
  for (int k = 1; file.written(fmt::format("structure.sections[{}]", k)); ++k)
    add(fmt::format("structure.sections[{}].{}", k, key));
  if (keys.empty()) return;
  file.set(fmt::format("spread.{}={{keys=[{}],distribution=\"normal\",cov=\"{}\"}}", key, fmt::join(keys, ","), cov));
}

}  // namespace

bool assume_spread(SceneFile& file) {
  if (file.written("spread")) return false;
  std::vector<std::string> gaps;
  for (const std::string& key : file.keys("gap")) gaps.push_back(fmt::format("\"gap.{}\"", key));
  for (const std::string section : {"electrode", "contact"}) {
    for (const std::string& name : file.keys(section)) {
      const std::string key = fmt::format("{}.{}.gap", section, name);
      if (file.written(key)) gaps.push_back('"' + key + '"');
    }
  }
  if (const auto kind = law_named<StructureKind>(file.written("structure.kind").value_or(""))) {
    std::visit(
        [&](const auto& own) {
          for (const UsualSpread& usual : own.usual_spread) {
            if (file.written("structure.sections")) {
              vary_sections(file, usual.key, usual.cov);
              continue;
            }
            vary(file, "structure." + std::string(usual.key), usual.cov, usual.has_default);
          }
        },
        *kind);
  }
  if (!gaps.empty()) file.set(fmt::format("spread.gaps={{keys=[{}],distribution=\"normal\",cov=\"2 %\"}}", fmt::join(gaps, ",")));
  return true;
}

}  // namespace softland
