// Words for the reports on a closing: clauses that describe a run by its figures of merit, the figures as text for tables, and
// what the waveforms of the drives demand of the voltage sources.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "objectives/figure_values.h"
#include "objectives/figures.h"
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

enum class Verdict { better, worse, same, neutral };

/// The change of a figure from the plain step to the best waveform: "8.4 times lower" (a time: shorter, a count: fewer), "none
/// left" when the figure became 0, "unchanged"; empty when either value is missing.
struct Change {
  std::string words;
  Verdict verdict = Verdict::neutral;
};
enum class ChangeKind { size, time, count };
/// Returns the change of a figure of merit in words. If `lower_is_better`, the verdict is better or worse, else neutral.
[[nodiscard]] Change change(double before, double after, bool lower_is_better, ChangeKind kind = ChangeKind::size);
[[nodiscard]] Change figure_change(const RunRecord& before, const RunRecord& after, const Figure& figure);

/// Returns the value of a figure of merit as text, rounded to its error if the error is known; an em dash when not available. A
/// value of 0 is given in the unit of `beside`, the value in the neighbouring cell.
[[nodiscard]] std::string figure_text(const Figure& figure, double value, double error, double beside);
/// Returns the error of a figure whose value figure_text() shows; an em dash when unknown.
[[nodiscard]] std::string error_text(const Figure& figure, double value, double error);
/// Returns the reason why a figure of merit of a run is not available: "no contact", "not settled"; empty if the figure is
/// available.
[[nodiscard]] std::string missing_reason(const RunRecord& run, const Figure& figure);
/// Describes the values of an ill-conditioned figure of merit in repeated runs: "median 305.5 µs, 280.5 µs to 336.1 µs in 16
/// runs"; empty without repeated runs, and for any other figure.
[[nodiscard]] std::string cloud_text(const ClosingRecord& result, const Figure& figure);
/// Returns the heading of the table column with the errors of figures of merit; the heading names the kind of errors.
[[nodiscard]] std::string error_heading(const ClosingRecord& result);
/// Describes in a sentence or two how reliable the figures are according to repeated runs with slightly changed settings, and
/// the rebound from which these runs differ; empty without repeated runs.
[[nodiscard]] std::string certificate_caption(const ClosingRecord& result);
/// Returns the goal of the search for a figure of merit: "0", "yes", "below 323.1 µs"; empty if the search had no goal for the
/// figure.
[[nodiscard]] std::string goal_text(const ClosingRecord& result, const Figure& figure);

/// The quantity that a waveform prescribes: the voltage of an electrode or a piezo, or the factor of the dispersion force.
struct DriveScale {
  std::string_view name;  ///< name of the quantity, as the first word of a sentence
  std::string_view unit;  ///< unit of the quantity; empty: a plain number
  double rest = 0;        ///< level of the waveform before t = 0, in the unit of the quantity
};
/// Returns the quantity that a waveform prescribes. `drive` names an electrode or a piezo (a voltage), or is "dispersion" (a
/// factor).
[[nodiscard]] DriveScale drive_scale(std::string_view drive);
[[nodiscard]] DriveLimits drive_limits(const ClosingRecord& result, const std::string& drive);
/// Returns the waveform of an electrode, a piezo or the dispersion force in a run; empty if the run has none of that name.
[[nodiscard]] const Points& waveform(const RunRecord& run, const std::string& drive);
/// The voltages and the slew rate that a waveform, which begins at the level `rest`, demands of its voltage source.
struct DriveDemand {
  double lowest = 0, highest = 0;  ///< lowest and highest level of the waveform [V]; NaN without a waveform
  double slew = 0;                 ///< largest slew rate of the waveform [V/s]; infinite where the waveform jumps
  [[nodiscard]] double peak() const;
};
[[nodiscard]] DriveDemand drive_demand(const Points& waveform, double rest);

}  // namespace softland::internal
