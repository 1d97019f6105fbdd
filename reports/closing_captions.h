// Captions for the record of a closing, computed from its numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reports/closing_record.h"

namespace softland::internal {

/// The finding in one sentence, in two parts so that a page can weigh them differently. The part `main` is about the winner or
/// the single run; `rest` is about the baseline (empty for a single run). main + rest is the whole sentence, with its full
/// stop.
struct Headline {
  std::string main;
  std::string rest;
  [[nodiscard]] std::string whole() const { return main + rest; }
};
[[nodiscard]] Headline headline(const ClosingRecord& result);

/// Returns the simulated time [s]: the last time of any curve; NaN without curves.
[[nodiscard]] double window_end(const ClosingRecord& record);
/// Returns the indices of the listed evaluations of a search, ascending; they may have gaps.
[[nodiscard]] std::vector<double> evaluation_indices(const SearchCourse& course);
/// Counts the evaluations up to and with the one of this index; returns the index itself where none are listed.
[[nodiscard]] double evaluations_until(const std::vector<double>& indices, double index);

/// Each of these returns one or two sentences for below a chart.
[[nodiscard]] std::string gap_caption(const ClosingRecord& result);
[[nodiscard]] std::string contact_caption(const ClosingRecord& result);
[[nodiscard]] std::string landing_caption(const ClosingRecord& result);
[[nodiscard]] std::string force_caption(const ClosingRecord& result);
[[nodiscard]] std::string velocity_caption(const ClosingRecord& result);
[[nodiscard]] std::string waveform_caption(const ClosingRecord& result, const std::string& drive);
[[nodiscard]] std::string search_caption(const ClosingRecord& result, const SearchRecord& search);
[[nodiscard]] std::string checks_caption(const SearchRecord& search);
/// Names the searched waveform families, each with its least cost; empty where there was one.
[[nodiscard]] std::string families_caption(const SearchRecord& search);
/// Gives the result of a search under process variation; empty for any other search.
[[nodiscard]] std::string robust_caption(const ClosingRecord& result);
/// Compares the winner with the least time of any waveform; empty where that is not known.
[[nodiscard]] std::string limit_prose(const ClosingRecord& result);
/// Returns false when the winner is bounce-free but one of its confirmations under its own gas law is not.
[[nodiscard]] bool checks_agree(const ClosingRecord& result);
/// Tells whether the winner closes bounce-free in all confirmations.
[[nodiscard]] bool all_checks_land(const SearchRecord& search);
/// Returns the worst closing: one that stays open, then the highest rebound, then the highest impact velocity. Null without
/// checks.
[[nodiscard]] const ConfirmationRecord* worst_check(const std::vector<ConfirmationRecord>& checks);
/// Returns the key of the figure that makes it the worst.
[[nodiscard]] std::string_view worst_figure(const ConfirmationRecord& check);

/// Returns "Softland's waveform" and "plain step", or "closing" for a single run.
[[nodiscard]] std::string best_label(const ClosingRecord& result);
[[nodiscard]] std::string baseline_label();

}  // namespace softland::internal
