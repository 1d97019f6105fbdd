// Reading a result whose every part is optional: what is missing, null or of another type is "not available".
#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace softland::internal {

/// The value at this path of keys; a null value when any of them is missing.
[[nodiscard]] const nlohmann::json& at(const nlohmann::json& value, std::initializer_list<std::string_view> path);
/// NaN unless the value is a number.
[[nodiscard]] double number(const nlohmann::json& value);
[[nodiscard]] double number(const nlohmann::json& value, std::initializer_list<std::string_view> path);
/// Empty unless the value is a string.
[[nodiscard]] std::string text(const nlohmann::json& value, std::initializer_list<std::string_view> path);
/// Not set unless the value is true or false.
[[nodiscard]] std::optional<bool> truth(const nlohmann::json& value, std::initializer_list<std::string_view> path);
/// A number as a chart takes it: NaN beyond 1e100 and 0 within 1e-100 of 0. Nothing of a switch is like that, and what a damaged
/// file holds would overflow on its way to the picture.
[[nodiscard]] double drawable(double value);
[[nodiscard]] double drawable(const nlohmann::json& value);
/// The drawable numbers of an array, NaN for what is none; empty unless the value is an array.
[[nodiscard]] std::vector<double> numbers(const nlohmann::json& value);

[[nodiscard]] bool is_optimize(const nlohmann::json& result);
/// Figures of the winner or of the single run, of the baseline; null when there are none.
[[nodiscard]] const nlohmann::json& best_metrics(const nlohmann::json& result);
[[nodiscard]] const nlohmann::json& baseline_metrics(const nlohmann::json& result);
/// The simulated time [s]: the last time of any curve; NaN without curves.
[[nodiscard]] double window_end(const nlohmann::json& result);
/// Indices of the listed evaluations of a search, ascending; they may have gaps.
[[nodiscard]] std::vector<double> evaluation_indices(const nlohmann::json& result);
/// How many evaluations had been made up to and with the one of this index; the index itself where none are listed.
[[nodiscard]] double evaluations_until(const std::vector<double>& indices, double index);
/// What a drive's waveform is made of.
struct DriveScale {
  std::string_view name;  ///< at the beginning of a sentence
  std::string_view unit;  ///< empty: a plain number
  double rest = 0;        ///< before t = 0
};
/// Volts, or the factor of the drive named "dispersion".
[[nodiscard]] DriveScale drive_scale(std::string_view drive);
/// A quantity as a resolved scene writes it, "2 um", in SI units; a plain number as it is; NaN for anything else.
[[nodiscard]] double quantity_of(const nlohmann::json& value);
/// What the source of a drive can do; NaN where the scene sets no limit.
struct DriveLimits {
  double lowest = 0, highest = 0;  ///< [V]
  double slew = 0;                 ///< [V/s]
};
[[nodiscard]] DriveLimits drive_limits(const nlohmann::json& result, const std::string& drive);
/// What a waveform [[time, level], ...] demands of its source from `rest` on.
struct DriveDemand {
  double lowest = 0, highest = 0;  ///< NaN: there is no waveform
  double slew = 0;                 ///< infinite where it jumps
  [[nodiscard]] double peak() const;
};
[[nodiscard]] DriveDemand drive_demand(const nlohmann::json& waveform, double rest);
/// Height from which a rebound counts [m]; 1 nm unless the scene says otherwise.
[[nodiscard]] double significant_rebound(const nlohmann::json& result);

}  // namespace softland::internal
