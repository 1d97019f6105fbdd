// What a search for devices came to: the first words, the table that stands before all others, and the front of closing time
// against impact speed; as text and as HTML.
#pragma once

#include <string>
#include <vector>

#include "reports/document.h"
#include "reports/result.h"
#include "studies/search/for_devices.h"

namespace softland {

/// `next_command`: how a measured device gets its waveform; empty where it cannot.
[[nodiscard]] ResultDevices devices_of(const ForDevicesResult& found, const OptimizeOptions& options, std::string next_command);

namespace internal {

/// Says how the waveform for the nominal design closes it.
[[nodiscard]] std::string drawing_words(const ResultDevices& devices);
/// Says in a sentence how the waveform of best.toml closes the devices.
[[nodiscard]] std::string devices_headline(const Result& result);
/// What stands above all else on a page: shares and 95 % quantiles of the devices, from plain step to winner.
[[nodiscard]] std::vector<KeyNumber> devices_keys(const ResultDevices& devices);
/// A terminal shows the choices beside the plain step, what measuring wins, and the nominal design.
[[nodiscard]] ReportSection choices_section(const ResultDevices& devices);
/// A page shows all rows, the front, what knowing a device is worth.
[[nodiscard]] ReportSection devices_section(const ResultDevices& devices);

}  // namespace internal
}  // namespace softland
