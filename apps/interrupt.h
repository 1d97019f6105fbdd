// Signals that ask the program to end.
#pragma once

#include <array>
#include <atomic>
#include <csignal>

namespace softland::apps {

/// Signals that ask the program to end: Ctrl-C, a scheduler, `kill`, or a closed terminal.
inline constexpr std::array stopping_signals{SIGINT, SIGTERM, SIGHUP, SIGXCPU};

/// Makes every signal of `stopping_signals` set stop_requested(); a second SIGINT ends the program at once. Repetitions of the
/// other signals have no further effect, so that the results so far are still written: a closing terminal sends SIGHUP twice,
/// the kernel sends SIGXCPU every second. A signal that was ignored at the start, as under nohup, stays ignored. Writing to a
/// closed pipe, or beyond the limit of file sizes, becomes an error of the write instead of a signal.
void catch_signals();

[[nodiscard]] const std::atomic<bool>& stop_requested();

}  // namespace softland::apps
