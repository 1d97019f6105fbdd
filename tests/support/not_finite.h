// Numbers that no quantity may have.
#pragma once

#include <limits>

namespace softland {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace softland
