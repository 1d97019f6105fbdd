// JSON has no non-finite numbers: a number that is not finite becomes null.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace softland::internal {

[[nodiscard]] inline nlohmann::json json_number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

}  // namespace softland::internal
