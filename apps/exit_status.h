// The exit statuses of the program and their meaning, which --help, the manual page and docs/commands.md list.
#pragma once

#include <array>
#include <string_view>

namespace softland::apps {

inline constexpr int exit_done = 0;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_numerical_failure = 3;
inline constexpr int exit_no_success = 4;
inline constexpr int exit_build_failed = 5;     ///< only the launcher ends with it: `softland` at the root of the sources
inline constexpr int exit_internal_error = 70;  ///< the statuses 70, 71 and 74 have the numbers of sysexits.h
inline constexpr int exit_system_error = 71;
inline constexpr int exit_output_lost = 74;
inline constexpr int exit_interrupted = 130;

struct ExitStatus {
  int status;
  std::string_view about;
};

inline constexpr std::array exit_statuses{
    ExitStatus{exit_done, "done; also a switch that stays open as commanded"},
    ExitStatus{exit_bad_input, "bad input, something unavailable, or missing packages"},
    ExitStatus{exit_numerical_failure, "numerical failure"},
    ExitStatus{exit_no_success, "done without success: the switch stays open, or nothing is better than the plain step"},
    ExitStatus{exit_build_failed, "the build failed (launcher)"},
    ExitStatus{exit_internal_error, "internal error: a fault of softland, please report it"},
    ExitStatus{exit_system_error, "no memory or threads from the system"},
    ExitStatus{exit_output_lost,
               "output lost: full disk, closed pipe, or a folder or database that was removed or replaced during the run"},
    ExitStatus{exit_interrupted, "interrupted by SIGINT (Ctrl-C), SIGTERM, SIGHUP or SIGXCPU; the results so far are written"},
};

}  // namespace softland::apps
