// The findings of a search for devices: the headline, the table that stands before all others, and the front of closing time
// against impact velocity; as text and as HTML.
#pragma once

#include <string>
#include <vector>

#include "document/document.h"
#include "reports/closing_record.h"
#include "studies/search/devices_findings.h"

namespace softland {

namespace internal {

/// Says how the waveform for the nominal design closes it.
[[nodiscard]] std::string drawing_prose(const DevicesFindings& devices);
/// Says in a sentence how the waveform of best.toml closes the devices.
[[nodiscard]] std::string devices_headline(const ClosingRecord& result);
/// Returns the key numbers at the top of a page: shares and 95th percentiles of the devices, from plain step to winner.
[[nodiscard]] std::vector<KeyNumber> devices_keys(const DevicesFindings& devices);
/// Shows the choices beside the plain step, what measuring wins, and the nominal design, for a terminal.
[[nodiscard]] ReportSection choices_section(const DevicesFindings& devices);
/// Shows all rows, the front and the value of measuring a device, for a page.
[[nodiscard]] ReportSection devices_section(const DevicesFindings& devices);

}  // namespace internal
}  // namespace softland
