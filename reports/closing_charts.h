// Charts of the record of a closing: its curves over time, its drives and the course of its search.
#pragma once

#include <string>
#include <vector>

#include "document/chart.h"
#include "reports/closing_record.h"

namespace softland {

/// Returns a static SVG document, 900 px wide: the finding in words, gap against time of baseline and winner (the whole closing
/// and the landing enlarged) and the drive waveforms below. Parts that the result lacks are left out.
[[nodiscard]] std::string svg_gap_chart(const ClosingRecord& result);
/// Returns the charts of that document.
[[nodiscard]] internal::Picture gap_and_drives(const ClosingRecord& result);

namespace internal {

/// Returns all charts of a result, in the order of the page: gap, contact, landing, drives, velocity, force, resistance,
/// search. It leaves out charts that have no data.
[[nodiscard]] Picture picture(const ClosingRecord& result);
/// Returns when a contact is closed, until `window` [s]: columns time_s and closed, for a chart of bars.
[[nodiscard]] CurveTable closed_table(const std::vector<ClosedStretch>& closed, double window);

}  // namespace internal
}  // namespace softland
