// The gaps of devices under the plain step and under best.toml, as pictures side by side.
#pragma once

#include <string>

#include "document/chart.h"
#include "reports/closing_record.h"

namespace softland {

/// Returns a static SVG document of a search over devices: its headline, the gaps of devices, and the waveforms of the drives
/// below.
[[nodiscard]] std::string svg_devices(const ClosingRecord& result);

namespace internal {

/// Returns two charts, with a curve for each device, the median and the band of 5 to 95 %; none where no gaps were kept.
[[nodiscard]] Picture gaps_picture(const DevicesFindings& devices);
/// Returns the same for a page.
[[nodiscard]] std::string gaps_html(const DevicesFindings& devices);

}  // namespace internal
}  // namespace softland
