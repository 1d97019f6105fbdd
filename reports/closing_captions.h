// Captions for the report on a closing or a search, computed from its results (closing_record.h).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reports/closing_record.h"

namespace softland::internal {

/// The result in one sentence, in two parts of different weight on a page. The part `main` is about the best waveform or the
/// single run; `rest` is about the plain step (empty for a single run). main + rest is the complete sentence with its full
/// stop.
struct Headline {
  std::string main;
  std::string rest;
  [[nodiscard]] std::string whole() const { return main + rest; }
};
[[nodiscard]] Headline headline(const ClosingRecord& result);

/// Returns the simulated time of the runs in the results of a closing [s]: the last time of any curve; NaN without curves.
[[nodiscard]] double window_end(const ClosingRecord& record);
/// Returns the indices of the evaluations that the results of a search list, ascending; the list may leave out evaluations.
[[nodiscard]] std::vector<double> evaluation_indices(const SearchCourse& course);
/// Returns the number of evaluations up to the evaluation `index`: those in the list `indices`, which may leave out some. With
/// an empty list, all are assumed to be present: returns `index`.
[[nodiscard]] double evaluations_until(const std::vector<double>& indices, double index);

/// The functions from gap_caption() to checks_caption() each return one or two sentences as the caption of a chart.
[[nodiscard]] std::string gap_caption(const ClosingRecord& result);
[[nodiscard]] std::string contact_caption(const ClosingRecord& result);
[[nodiscard]] std::string landing_caption(const ClosingRecord& result);
[[nodiscard]] std::string force_caption(const ClosingRecord& result);
[[nodiscard]] std::string velocity_caption(const ClosingRecord& result);
[[nodiscard]] std::string waveform_caption(const ClosingRecord& result, const std::string& drive);
[[nodiscard]] std::string search_caption(const ClosingRecord& result, const SearchRecord& search);
[[nodiscard]] std::string checks_caption(const SearchRecord& search);
/// Names the searched waveform families, each with its least cost; empty if there was only one family.
[[nodiscard]] std::string families_caption(const SearchRecord& search);
/// States the result of a search under process variation; empty for any other search.
[[nodiscard]] std::string robust_caption(const ClosingRecord& result);
/// Compares the best waveform with the least closing time of any waveform; empty if that least time is unknown.
[[nodiscard]] std::string limit_prose(const ClosingRecord& result);
/// Returns false if the best waveform closes without a bounce in the search, but bounces in a confirmation with another
/// integrator tolerance or number of modes.
[[nodiscard]] bool checks_agree(const ClosingRecord& result);
/// Returns true if the best waveform closes without a bounce in all confirmations (re-runs with other numerical settings).
[[nodiscard]] bool all_checks_land(const SearchRecord& search);
/// Returns the worst of the confirmations (re-runs with other settings): one in which the switch stays open, else that of the
/// highest rebound, else that of the highest impact velocity. Returns null without confirmations.
[[nodiscard]] const ConfirmationRecord* worst_check(const std::vector<ConfirmationRecord>& checks);
/// Returns the key of the figure (time of first contact if the switch stays open, rebound height or impact velocity) by which
/// this confirmation is the worst.
[[nodiscard]] std::string_view worst_figure(const ConfirmationRecord& check);

/// Returns the name of the best waveform in legends: "Softland's waveform"; "closing" for a single run.
[[nodiscard]] std::string best_label(const ClosingRecord& result);
[[nodiscard]] std::string baseline_label();

}  // namespace softland::internal
