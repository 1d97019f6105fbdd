// What the record of a closing says, in words computed from its numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reports/closing_record.h"

namespace softland::internal {

/// The finding in one sentence, in two parts so that a page can weigh them differently: `main` is about the winner or the single
/// run, `rest` about the baseline (empty for a single run). main + rest is the whole sentence, with its full stop.
struct Headline {
  std::string main;
  std::string rest;
  [[nodiscard]] std::string whole() const { return main + rest; }
};
[[nodiscard]] Headline headline(const ClosingRecord& result);

/// The simulated time [s]: the last time of any curve; NaN without curves.
[[nodiscard]] double window_end(const ClosingRecord& record);
/// Indices of the listed evaluations of a search, ascending; they may have gaps.
[[nodiscard]] std::vector<double> evaluation_indices(const SearchCourse& course);
/// How many evaluations had been made up to and with the one of this index; the index itself where none are listed.
[[nodiscard]] double evaluations_until(const std::vector<double>& indices, double index);

/// One sentence or two under each chart.
[[nodiscard]] std::string gap_caption(const ClosingRecord& result);
[[nodiscard]] std::string contact_caption(const ClosingRecord& result);
[[nodiscard]] std::string landing_caption(const ClosingRecord& result);
[[nodiscard]] std::string force_caption(const ClosingRecord& result);
[[nodiscard]] std::string velocity_caption(const ClosingRecord& result);
[[nodiscard]] std::string waveform_caption(const ClosingRecord& result, const std::string& drive);
[[nodiscard]] std::string search_caption(const ClosingRecord& result, const SearchRecord& search);
[[nodiscard]] std::string checks_caption(const SearchRecord& search);
/// The families that were searched, each with its least cost; empty where there was one.
[[nodiscard]] std::string families_caption(const SearchRecord& search);
/// What a search over devices that differ came to; empty for any other.
[[nodiscard]] std::string robust_caption(const ClosingRecord& result);
/// How near the winner comes to the least time of any waveform; empty where that is not known.
[[nodiscard]] std::string limit_words(const ClosingRecord& result);
/// False when the winner is free of rebounds but one of its confirmations under its own gas law is not.
[[nodiscard]] bool checks_agree(const ClosingRecord& result);
/// Whether the winner closes without a rebound in all confirmations.
[[nodiscard]] bool all_checks_land(const SearchRecord& search);
/// The closing to fear most: one that stays open, then the highest rebound, then the fastest touch. Null where there is none.
[[nodiscard]] const ConfirmationRecord* worst_check(const std::vector<ConfirmationRecord>& checks);
/// The key of the figure that makes it so.
[[nodiscard]] std::string_view worst_figure(const ConfirmationRecord& check);

/// "Softland's waveform" and "plain step", or "closing" for a single run.
[[nodiscard]] std::string best_label(const ClosingRecord& result);
[[nodiscard]] std::string baseline_label();

}  // namespace softland::internal
