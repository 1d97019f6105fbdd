// Reads the aim of a search from text: a target, the quantity to minimise ("bounce"), or a weighted sum of targets ("0.7 bounce
// + 0.3 energy").
#pragma once

#include <string_view>

#include "objectives/cost.h"

namespace softland {

/// Reads the aim of a search. Throws InvalidInput whose message states the rule that the text breaks.
[[nodiscard]] Aim parse_aim(std::string_view text);

}  // namespace softland
