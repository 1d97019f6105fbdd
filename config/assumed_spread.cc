#include "config/assumed_spread.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

namespace softland {
namespace {

void vary(SceneFile& file, const std::string& key, const std::string& cov) {
  if (file.written(key)) file.set(fmt::format("spread.\"{}\"={{distribution=\"normal\",cov=\"{}\"}}", key, cov));
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
  if (file.written("structure.kind") == "plate") {
    vary(file, "structure.stiffness", "6.7 %");
  } else if (file.written("structure.kind") == "modes") {
    file.set("spread.\"structure.frequency_factor\"={distribution=\"normal\",cov=\"3.5 %\"}");
  } else {
    vary(file, "structure.thickness", "2 %");
    vary(file, "structure.youngs_modulus", "3 %");
  }
  if (!gaps.empty()) file.set(fmt::format("spread.gaps={{keys=[{}],distribution=\"normal\",cov=\"2 %\"}}", fmt::join(gaps, ",")));
  return true;
}

}  // namespace softland
