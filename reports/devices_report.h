// What a search for devices came to: the first words, the table that stands before all others, and the front of closing time
// against impact speed; as text and as HTML.
#pragma once

#include <string>
#include <vector>

#include "reports/closing_record.h"
#include "reports/document.h"
#include "studies/search/devices_findings.h"

namespace softland {

namespace internal {

/// Says how the waveform for the nominal design closes it.
[[nodiscard]] std::string drawing_words(const DevicesFindings& devices);
/// Says in a sentence how the waveform of best.toml closes the devices.
[[nodiscard]] std::string devices_headline(const ClosingRecord& result);
/// What stands above all else on a page: shares and 95 % quantiles of the devices, from plain step to winner.
[[nodiscard]] std::vector<KeyNumber> devices_keys(const DevicesFindings& devices);
/// A terminal shows the choices beside the plain step, what measuring wins, and the nominal design.
[[nodiscard]] ReportSection choices_section(const DevicesFindings& devices);
/// A page shows all rows, the front, what knowing a device is worth.
[[nodiscard]] ReportSection devices_section(const DevicesFindings& devices);

}  // namespace internal
}  // namespace softland
