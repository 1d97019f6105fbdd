// The program ends with these exit statuses, which docs/commands.md and --help list.
#pragma once

namespace softland::apps {

inline constexpr int exit_done = 0;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_numerical_failure = 3;
inline constexpr int exit_no_success = 4;
inline constexpr int exit_internal_error = 70;  ///< these three have the numbers of sysexits.h
inline constexpr int exit_system_error = 71;
inline constexpr int exit_output_lost = 74;
inline constexpr int exit_interrupted = 130;

}  // namespace softland::apps
