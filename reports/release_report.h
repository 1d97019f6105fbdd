// What `softland release` found: JSON with SI units in the names, a table for a terminal, the drives as CSV, and a picture.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/result_maker.h"
#include "studies/search/opening.h"

namespace softland {

/// What is to be warned of: the scene, and a contact force at hold that few summits carry.
[[nodiscard]] std::vector<std::string> warnings(const OpeningResult& result);

[[nodiscard]] nlohmann::json release_json(const OpeningResult& release, const Provenance& provenance);
[[nodiscard]] std::string release_text(const OpeningResult& release);
/// Gap of the plain opening and of the best, and the drives.
[[nodiscard]] std::string release_svg(const OpeningResult& release);
/// The drives of the best opening, or where there is none of the plain one, from the hold levels on: a header
/// `time_s,<drive>,...` [s, V], straight lines between the rows; rows of the same time are a jump.
[[nodiscard]] std::string release_csv(const OpeningResult& release);

}  // namespace softland
