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

}  // namespace

bool assume_spread(SceneFile& file) {
  if (file.written("spread")) return false;
  std::vector<std::string> gaps;
  for (const std::string& key : file.keys("gap")) gaps.push_back(fmt::format("\"gap.{}\"", key));
  for (const std::string& name : file.keys("electrode")) {
    const std::string key = fmt::format("electrode.{}.gap", name);
    if (file.written(key)) gaps.push_back('"' + key + '"');
  }
  if (const auto kind = law_named<StructureKind>(file.written("structure.kind").value_or(""))) {
    std::visit(
        [&](const auto& own) {
          for (const UsualSpread& usual : own.usual_spread)
            vary(file, "structure." + std::string(usual.key), usual.cov, usual.has_default);
        },
        *kind);
  }
  if (!gaps.empty()) file.set(fmt::format("spread.gaps={{keys=[{}],distribution=\"normal\",cov=\"2 %\"}}", fmt::join(gaps, ",")));
  return true;
}

}  // namespace softland
