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

/// Returns "structure.thickness ± 2 % (normal), ...".
[[nodiscard]] std::string spread_words(const DeviceSpread& spread);
/// Returns a sentence where the sources of the drives err; empty where they do not.
[[nodiscard]] std::string_view error_words(const DeviceSpread& spread);
/// Says how many devices are outside the model, and why the first of them is; empty where none is.
[[nodiscard]] std::string outside_words(const Robustness& found);
/// Returns "Vdp ± 1 %, frequency ± 0.5 %".
[[nodiscard]] std::string calibration_words(const Calibration& calibration);
[[nodiscard]] bool is_erring(const Calibration& calibration);

/// Names the hold levels that keep 99 % of the devices closed; empty where nothing is known of them.
[[nodiscard]] std::string window_words(const HoldWindows& windows);

/// Returns the varying quantities of device k, as they are shown.
[[nodiscard]] std::vector<double> shown_values(const Ensemble& ensemble, std::size_t k);
/// Tells whether a table has a row of the figure, one of device_figures. It has none where devices close and none has the
/// figure, such as the peak force on a rigid contact.
[[nodiscard]] bool is_had(const RobustnessRecord& found, const Figure& figure);
/// Tells whether some drive pulls the beam of a device onto the electrode.
[[nodiscard]] bool some_collapse(const RobustnessRecord& found);
/// This sentence says how a device without a figure counts.
inline constexpr std::string_view worst_words =
    "A device without a figure, as it does not close or has not settled, counts as the worst: ∞.";
[[nodiscard]] const EstimatedQuantile& quantile_95(const RobustnessRecord::Drive& drive, std::string_view key);

/// Returns a Sobol' index as a share: its estimate may leave [0, 1] by chance, a share cannot.
[[nodiscard]] inline double share_of(double index) { return std::clamp(index, 0.0, 1.0); }
/// Says why a figure has no indices: its devices may all close in the sample, but the devices of the indices are others.
[[nodiscard]] std::string why_no_indices(std::size_t rows, std::size_t failed_rows);

}  // namespace softland::internal
