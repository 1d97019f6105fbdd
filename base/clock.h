// The time that budgets are held against. What spends one takes its clock as an option, so that a test can give it another.
#pragma once

#include <chrono>

namespace softland {

/// Of this machine, since some moment [s].
[[nodiscard]] inline double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace softland
