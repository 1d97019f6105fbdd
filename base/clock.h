// The time for budgets. A computation with a budget takes its clock as an option, so that a test can pass another.
#pragma once

#include <chrono>

namespace softland {

/// Returns the time of this machine since some moment [s].
[[nodiscard]] inline double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace softland
