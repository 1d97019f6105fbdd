// Draws the gaps of devices under the plain step and under the waveform of best.toml, side by side.
#pragma once

#include <string>

#include "document/chart.h"
#include "reports/closing_record.h"

namespace softland {

/// Returns a static SVG document on a search over devices: the headline, the gaps of devices over time, and the waveforms of
/// the drives.
[[nodiscard]] std::string svg_devices(const ClosingRecord& result);

namespace internal {

/// Returns two charts of the gap over time, for plain step and best.toml: a curve per device, the median, and the band from 5
/// to 95 %. Returns none if no gaps were recorded.
[[nodiscard]] Picture gaps_picture(const DevicesFindings& devices);
/// Returns the charts of gaps_picture() as HTML for a page.
[[nodiscard]] std::string gaps_html(const DevicesFindings& devices);

}  // namespace internal
}  // namespace softland
