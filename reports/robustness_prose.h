// Words and numbers that the text, the table of devices, the JSON and the page of `softland robustness` share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "reports/robustness_report.h"
#include "studies/devices/hold_window.h"
#include "studies/devices/robustness.h"

namespace softland::internal {

/// Returns the name by which reports show a set of waveforms: the file of a waveform found under process variation, or else
/// `name`.
[[nodiscard]] std::string shown_drive(const std::string& name);
/// Returns the same name for use in a sentence: "the plain step", "best.toml".
[[nodiscard]] std::string with_article(const std::string& name);

/// Returns a number of devices in words: "1 device", "2000 devices".
[[nodiscard]] std::string devices_text(std::uint64_t devices);
/// Describes the process variation in words: "structure.thickness ± 2 % (normal), ...".
[[nodiscard]] std::string spread_prose(const DeviceSpread& spread);
/// Returns a sentence about the errors of the voltage sources that vary between devices; empty for exact sources.
[[nodiscard]] std::string_view error_prose(const DeviceSpread& spread);
/// Returns the number of devices whose varied values are outside the limits of the model, and the reason for the first of them;
/// empty if all devices are inside.
[[nodiscard]] std::string outside_prose(const Robustness& found);
/// Describes the measurements of a per-device calibration with their errors: "Vdp ± 1 %, frequency ± 0.5 %".
[[nodiscard]] std::string calibration_prose(const Calibration& calibration);
[[nodiscard]] bool is_erring(const Calibration& calibration);

/// Describes the hold voltages that keep 99 % of the devices closed; empty if they are unknown.
[[nodiscard]] std::string window_prose(const HoldWindows& windows);

/// Returns the varying quantities of device k for display: in SI units, or as factors of the nominal value. The jitter of the
/// voltage source is shown as the random time shift of the waveform's first edge [s].
[[nodiscard]] std::vector<double> shown_values(const Ensemble& ensemble, std::size_t k);
/// Returns true if a table has a row for this figure of merit of device_figures. A figure that no closing device has, such as
/// the peak force on a rigid contact, has no row.
[[nodiscard]] bool is_had(const RobustnessRecord& found, const Figure& figure);
/// Returns true if some waveform pulls the beam of a device onto the electrode.
[[nodiscard]] bool some_collapse(const RobustnessRecord& found);
/// A sentence of reports on how statistics count a device that lacks a figure of merit.
inline constexpr std::string_view worst_prose =
    "A device without a figure, because it does not close or has not settled, counts as the worst: ∞.";
[[nodiscard]] const EstimatedQuantile& quantile_95(const RobustnessRecord::Drive& drive, std::string_view key);

/// Returns a Sobol' index clamped to [0, 1], which its estimate may leave by chance.
[[nodiscard]] inline double share_of(double index) { return std::clamp(index, 0.0, 1.0); }
/// Returns the reason why a figure of merit has no Sobol' indices. The indices need simulations of devices that are not in the
/// sample, in `rows` groups, of which `failed_rows` have a device without the figure.
[[nodiscard]] std::string why_no_indices(std::size_t rows, std::size_t failed_rows);

/// Returns a share of devices with its confidence interval as text: "3.4 % (2.7 to 4.3)".
[[nodiscard]] std::string yield_text(const Yield& yield);
/// Returns a quantile with its confidence interval as text: "26.9 mm/s (26.6 to 27.1)"; an infinite value is "∞".
[[nodiscard]] std::string quantile_text(const EstimatedQuantile& quantile, std::string_view unit);

}  // namespace softland::internal
