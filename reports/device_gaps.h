// The gaps of devices under the plain step and under best.toml, as pictures side by side.
#pragma once

#include <string>

#include "reports/chart.h"
#include "reports/closing_record.h"

namespace softland {

/// A static SVG document of a search over devices: its first words, the gaps of devices, and below them what the drives do.
[[nodiscard]] std::string svg_devices(const ClosingRecord& result);

namespace internal {

/// Two charts, with a curve for each device, the median and the band of 5 to 95 %; none where no gaps were kept.
[[nodiscard]] Picture gaps_picture(const DevicesFindings& devices);
/// The same for a page.
[[nodiscard]] std::string gaps_html(const DevicesFindings& devices);

}  // namespace internal
}  // namespace softland
