// What a closing does, told in clauses: of the figures of one run.
#pragma once

#include <optional>
#include <string>

#include "objectives/figures.h"
#include "reports/closing_record.h"

namespace softland::internal {

[[nodiscard]] bool touches(const FigureValues& figures);
[[nodiscard]] bool settles(const FigureValues& figures);
/// Touched, and nothing is known of what followed: the scene has no contact, or the run stopped.
[[nodiscard]] bool ends_at_touch(const FigureValues& figures);
/// Whether one contact of several has touched, and those that make the connection were never closed together.
[[nodiscard]] bool touches_in_part(const RunRecord& run);
/// Tells whether a run began closed: it came to its end, and no touch is its own.
[[nodiscard]] bool began_closed(const RunRecord& run);
/// Touched and settled without a significant rebound.
[[nodiscard]] bool is_clean(const FigureValues& figures);
/// The highest rebound [m], 0 where it is too low to be told from none.
[[nodiscard]] double rebound_height(const FigureValues& figures);
/// A figure of a run; NaN where there is no run.
[[nodiscard]] double figure_of_run(const RunRecord& run, Figure::Member member);

/// Of whom a clause speaks, and of what: "Softland's waveform" closes "the switch"; "the plain step" closes "it".
struct Actor {
  std::string subject;
  std::string object = {};  ///< empty: the subject is the switch itself
};
/// How a run closes, as a clause without full stop; `window` is the simulated time [s].
[[nodiscard]] std::string closing_clause(const Actor& actor, const RunRecord& run, double window);
/// How a run lands and what follows, as a clause; empty where the run is not there.
[[nodiscard]] std::string landing_clause(const std::string& subject, const RunRecord& run);

inline constexpr const char* own_subject = "softland's waveform";
inline constexpr const char* step_subject = "the plain step";

/// With a capital letter at the beginning.
[[nodiscard]] std::string capitalised(std::string words);
/// "A; b." with what is empty left out; empty when both are.
[[nodiscard]] std::string joined(const std::string& first, const std::string& second);

}  // namespace softland::internal
