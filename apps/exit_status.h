// The exit statuses of the program; docs/commands.md and --help list them.
#pragma once

namespace softland::apps {

inline constexpr int exit_done = 0;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_numerical_failure = 3;
inline constexpr int exit_no_success = 4;
inline constexpr int exit_internal_error = 70;  ///< the statuses 70, 71 and 74 have the numbers of sysexits.h
inline constexpr int exit_system_error = 71;
inline constexpr int exit_output_lost = 74;
inline constexpr int exit_interrupted = 130;

}  // namespace softland::apps
