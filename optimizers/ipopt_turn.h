// A lock for one solution by Ipopt at a time: two at once abort the process, since its linear solver MUMPS keeps global state.
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <thread>

namespace softland::internal {

/// Waits until no other solution by Ipopt runs, or until `gave_up()` returns true; in the latter case the returned lock is not
/// held.
[[nodiscard]] inline std::unique_lock<std::mutex> ipopt_turn(const std::function<bool()>& gave_up) {
  static std::mutex one_solve_at_a_time;
  constexpr std::chrono::milliseconds look_up{1};  // interval between attempts to take the lock
  std::unique_lock turn(one_solve_at_a_time, std::defer_lock);
  while (!turn.try_lock()) {
    if (gave_up()) break;
    std::this_thread::sleep_for(look_up);
  }
  return turn;
}

}  // namespace softland::internal
