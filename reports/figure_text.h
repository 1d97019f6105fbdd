// Formats the figures of merit of a result as text, one by one, for the tables of every report.
#pragma once

#include <optional>
#include <string>

#include "objectives/figures.h"
#include "reports/closing_record.h"

namespace softland::internal {

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

}  // namespace softland::internal
