// The clock of computations with a budget of time. A computation takes the clock as an option, so that a test can replace the
// clock.
#pragma once

#include <chrono>

namespace softland {

/// Returns the time since an arbitrary moment, by a clock that is never set back [s].
[[nodiscard]] inline double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace softland
