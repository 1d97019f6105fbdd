// Words and numbers that the text, the table of devices, JSON and the page of `softland robustness` share.
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

/// Returns the name of a drive as reports show it: the file with the waveform that a search for devices has found, or the name
/// that the drive has in the record.
[[nodiscard]] std::string shown_drive(const std::string& name);

/// Returns "structure.thickness ± 2 % (normal), ...".
[[nodiscard]] std::string spread_prose(const DeviceSpread& spread);
/// Returns a sentence about the errors of the voltage sources; empty for exact sources.
[[nodiscard]] std::string_view error_prose(const DeviceSpread& spread);
/// Says how many devices are outside the model, and why the first of these is; empty if all are inside.
[[nodiscard]] std::string outside_prose(const Robustness& found);
/// Returns "Vdp ± 1 %, frequency ± 0.5 %".
[[nodiscard]] std::string calibration_prose(const Calibration& calibration);
[[nodiscard]] bool is_erring(const Calibration& calibration);

/// Names the hold voltages that keep 99 % of the devices closed; empty where they are unknown.
[[nodiscard]] std::string window_prose(const HoldWindows& windows);

/// Returns the varying quantities of device k, as they are shown.
[[nodiscard]] std::vector<double> shown_values(const Ensemble& ensemble, std::size_t k);
/// Tells whether a table has a row for this figure, one of device_figures. A figure that no closing device has, such as the peak
/// force on a rigid contact, gets no row.
[[nodiscard]] bool is_had(const RobustnessRecord& found, const Figure& figure);
/// Tells whether some drive pulls the beam of a device onto the electrode.
[[nodiscard]] bool some_collapse(const RobustnessRecord& found);
/// This sentence says how a device without a figure counts.
inline constexpr std::string_view worst_prose =
    "A device without a figure, because it does not close or has not settled, counts as the worst: ∞.";
[[nodiscard]] const EstimatedQuantile& quantile_95(const RobustnessRecord::Drive& drive, std::string_view key);

/// Returns a Sobol' index as a share: its estimate may leave [0, 1] by chance, a share cannot.
[[nodiscard]] inline double share_of(double index) { return std::clamp(index, 0.0, 1.0); }
/// Says why a figure has no indices. The indices have devices of their own, which may stay open although the sample closes.
[[nodiscard]] std::string why_no_indices(std::size_t rows, std::size_t failed_rows);

}  // namespace softland::internal
