// Reads the aim of a search from text: a target ("bounce"), or a weighted sum of targets ("0.7 bounce + 0.3 energy").
#pragma once

#include <string_view>

#include "objectives/cost.h"

namespace softland {

/// Reads an aim. Throws InvalidInput with the broken rule.
[[nodiscard]] Aim parse_aim(std::string_view text);

}  // namespace softland
