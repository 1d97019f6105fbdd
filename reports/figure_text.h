// The figures of a result as text, one by one, for the tables of every report.
#pragma once

#include <optional>
#include <string>

#include "objectives/figures.h"
#include "reports/closing_record.h"

namespace softland::internal {

enum class Verdict { better, worse, same, neutral };

/// How a figure changed from baseline to winner: "8.4 times lower" (a time: shorter, a count: fewer), "none left" when it became
/// 0, "unchanged"; empty when either is missing.
struct Change {
  std::string words;
  Verdict verdict = Verdict::neutral;
};
enum class Kind { size, time, count };
/// `lower_is_better`: otherwise the change is neutral, neither good nor bad.
[[nodiscard]] Change change(double before, double after, bool lower_is_better, Kind kind = Kind::size);
[[nodiscard]] Change figure_change(const RunRecord& before, const RunRecord& after, const Figure& figure);

/// The value of a figure as text, rounded to its error where that is known; an em dash when not available; `beside` is the
/// value shown next to it.
[[nodiscard]] std::string figure_text(const Figure& figure, double value, double error, double beside);
/// The error beside that text; an em dash when not known.
[[nodiscard]] std::string error_text(const Figure& figure, double value, double error);
/// The reason in words when a figure of a run is not available: "no contact", "not settled"; else empty.
[[nodiscard]] std::string missing_reason(const RunRecord& run, const Figure& figure);
/// Of an ill-conditioned figure of a certified result: "median 305.5 µs, 280.5 µs to 336.1 µs in 16 runs"; else empty.
[[nodiscard]] std::string cloud_text(const ClosingRecord& result, const Figure& figure);
/// What the errors of the figures are errors of.
[[nodiscard]] std::string error_heading(const ClosingRecord& result);
/// What a certificate says of the figures and of the rebound at which the runs part, in a sentence or two; empty without one.
[[nodiscard]] std::string certificate_caption(const ClosingRecord& result);
/// What the search wanted of a figure: "0", "yes", "below 323.1 µs"; empty where it wanted nothing.
[[nodiscard]] std::string goal_text(const ClosingRecord& result, const Figure& figure);

}  // namespace softland::internal
