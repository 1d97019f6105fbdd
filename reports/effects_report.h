// The results of `softland effects`, which leaves out each physical effect of the model in turn: JSON with SI units in the
// names, and a table for a terminal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/origin.h"
#include "studies/closing/effects.h"

namespace softland {

struct EffectsRecord {
  Origin origin;
  Effects found;
};

/// Names the members of the JSON.
void members(internal::Archive& a, EffectsRecord& record);
[[nodiscard]] nlohmann::json json_of(const EffectsRecord& record);
/// Reads the results of `softland effects`. Throws InvalidInput for anything but the JSON of json_of().
[[nodiscard]] EffectsRecord read_effects(const nlohmann::json& from);
[[nodiscard]] std::string text_of(const EffectsRecord& record);

}  // namespace softland
