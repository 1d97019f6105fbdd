// Charts for the results of a closing or a search: curves over time, drive waveforms, and the best cost over the evaluations.
#pragma once

#include <string>
#include <vector>

#include "document/chart.h"
#include "reports/closing_record.h"

namespace softland {

/// Returns a static SVG document, 900 px wide: the result in words, the gap against time under the plain step and under the
/// best waveform (the whole closing, and the contact with its rebounds enlarged), and the drive waveforms below. Parts without
/// data are left out.
[[nodiscard]] std::string svg_gap_chart(const ClosingRecord& result);
/// Returns the charts of svg_gap_chart() as a description: the gap over time and the drive waveforms.
[[nodiscard]] internal::Picture gap_and_drives(const ClosingRecord& result);

namespace internal {

/// Returns all charts for the results of a closing or a search, in the order of the page: gap, contact, enlarged rebounds,
/// drive waveforms, velocity, force, resistance, search. Charts without data are left out.
[[nodiscard]] Picture picture(const ClosingRecord& result);
/// Returns the columns "time_s" and "closed" for a chart of bars: "closed" is 1 while the contact is closed, 0 while it is
/// open, until `window` [s].
[[nodiscard]] CurveTable closed_table(const std::vector<ClosedStretch>& closed, double window);

}  // namespace internal
}  // namespace softland
