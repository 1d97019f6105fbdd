// Draws the contact gaps of varied devices over time, side by side: under the plain step and under the best waveform.
#pragma once

#include <string>

#include "document/chart.h"
#include "reports/closing_record.h"

namespace softland {

/// Returns a static SVG document on a search under process variation: the headline, the contact gaps of the devices over time,
/// and the waveforms of the drives.
[[nodiscard]] std::string svg_devices(const ClosingRecord& result);

namespace internal {

/// Returns two charts of the contact gap over time, under the plain step and under the best waveform: a curve per varied
/// device, the median, and the band from 5 to 95 %. Returns none if no gaps were recorded.
[[nodiscard]] Picture gaps_picture(const DevicesFindings& devices);
/// Returns the charts of the contact gaps of varied devices over time, as gaps_picture() makes them, as HTML for a page.
[[nodiscard]] std::string gaps_html(const DevicesFindings& devices);

}  // namespace internal
}  // namespace softland
