// What `softland effects` found: JSON with SI units in the names, and a table for a terminal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/result_maker.h"
#include "studies/closing/effects.h"

namespace softland {

[[nodiscard]] nlohmann::json effects_json(const PreparedScene& prepared, const Effects& effects, const Provenance& provenance);
[[nodiscard]] std::string effects_text(const Effects& effects);

}  // namespace softland
