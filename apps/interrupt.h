// Signals ask the program to end.
#pragma once

#include <array>
#include <atomic>
#include <csignal>

namespace softland::apps {

/// These signals ask: Ctrl-C, a scheduler or `kill`, a terminal that is gone.
inline constexpr std::array stopping_signals{SIGINT, SIGTERM, SIGHUP, SIGXCPU};

/// Each of these signals sets stop_requested(); a second SIGINT ends the program at once. The others may come again before the
/// results so far are written: a terminal that closes sends SIGHUP twice, `timeout` SIGTERM, the kernel SIGXCPU every second. A
/// signal that the program was started to ignore, as by nohup, stays ignored. Writing to a closed pipe or beyond the limit of a
/// file's size is an error of that write, not a signal.
void catch_signals();

[[nodiscard]] const std::atomic<bool>& stop_requested();

}  // namespace softland::apps
