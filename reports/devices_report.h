// The results of a search under process variation: the headline, the main table, and the Pareto front of closing time against
// impact velocity, as text and as HTML.
#pragma once

#include <string>
#include <vector>

#include "document/document.h"
#include "reports/closing_record.h"
#include "studies/search/devices_findings.h"

namespace softland {

namespace internal {

/// Describes how the nominal design closes with the waveform that was searched for it alone.
[[nodiscard]] std::string nominal_prose(const DevicesFindings& devices);
/// Describes in a sentence how the devices close with the best waveform.
[[nodiscard]] std::string devices_headline(const ClosingRecord& result);
/// Returns the key numbers at the top of a page: shares and 95th percentiles of the devices, under the plain step and under the
/// best waveform.
[[nodiscard]] std::vector<KeyNumber> devices_keys(const DevicesFindings& devices);
/// Returns a section for a terminal: the waveforms among which the user can choose beside the plain step, the gain by
/// per-device calibration, and the nominal design.
[[nodiscard]] ReportSection choices_section(const DevicesFindings& devices);
/// Returns a section for a page: all found waveforms, the Pareto front of closing time and impact velocity, and the value of
/// calibrating each device.
[[nodiscard]] ReportSection devices_section(const DevicesFindings& devices);

}  // namespace internal
}  // namespace softland
