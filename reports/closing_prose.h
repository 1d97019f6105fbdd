// Clauses for the sentences of reports: they describe a closing by the figures of merit of one run.
#pragma once

#include <optional>
#include <string>

#include "objectives/figure_values.h"
#include "reports/closing_record.h"

namespace softland::internal {

[[nodiscard]] bool touches(const FigureValues& figures);
[[nodiscard]] bool settles(const FigureValues& figures);
/// Returns true if a run reaches the contact plane but has no figures of merit of the time after that: the scene has no
/// contact, or the simulation stopped.
[[nodiscard]] bool ends_at_touch(const FigureValues& figures);
/// Returns true if one of several contacts has touched, but the contacts that the electrical connection needs were never closed
/// together.
[[nodiscard]] bool touches_in_part(const RunRecord& run);
/// Returns true if a run began with a closed contact: the run was complete, but without a first touch.
[[nodiscard]] bool began_closed(const RunRecord& run);
/// Returns true for a run in which the switch touches its contact and settles without a significant rebound.
[[nodiscard]] bool is_clean(const FigureValues& figures);
/// Returns the height of the highest rebound [m]; 0 if the rebound is too low to be significant.
[[nodiscard]] double rebound_height(const FigureValues& figures);
/// Returns a figure of merit of a run; NaN if the run has no figures.
[[nodiscard]] double figure_of_run(const RunRecord& run, Figure::Member member);

/// The subject and the object of a clause: "softland's waveform" closes "the switch"; "the plain step" closes "it".
struct Actor {
  std::string subject;
  std::string object = {};  ///< object of the clause; empty: the subject is the switch itself
};
/// Describes how a run closes, as a clause without full stop; `window` is the simulated time [s]. `is_held` is false if the hold
/// levels are known to be too low to keep the switch closed.
[[nodiscard]] std::string closing_clause(const Actor& actor, const RunRecord& run, double window, bool is_held = true);
/// Describes how the switch touches its contact in a run, and what follows, as a clause about `subject`, such as "with the
/// plain step the switch"; empty if the run has no figures of merit.
[[nodiscard]] std::string landing_clause(const std::string& subject, const RunRecord& run);

inline constexpr const char* own_subject = "softland's waveform";
inline constexpr const char* step_subject = "the plain step";
inline constexpr const char* own_switch = "with softland's waveform the switch";
inline constexpr const char* step_switch = "with the plain step the switch";

/// Returns the words with a capital letter at the beginning.
[[nodiscard]] std::string capitalised(std::string words);
/// Joins two clauses to the sentence "A; b."; an empty clause is left out. Returns an empty text if both clauses are empty.
[[nodiscard]] std::string joined(const std::string& first, const std::string& second);

}  // namespace softland::internal
