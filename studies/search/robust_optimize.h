// The search for a waveform that performs well on devices with process variation, by one measure of risk.
//
// All candidates are tried on the same devices. Starts are those of the waveform family, the best of two searches on the
// nominal device, the waveform of the scene, the given waveforms, and points of the whole search space. All starts are tried on
// 8 devices, the best on 32, and CMA-ES begins at the best six on 32 devices. The search continues from the best two points on
// all devices, and then from the best point, by smaller steps. A candidate that is worse on the first 8 or 32 devices than the
// median of earlier candidates is not tried on the rest, and gets its cost on the first devices. The best point of every round
// is compared on 512 other devices. The best waveform is evaluated on 2000 fresh devices (new to the search) over the scene's
// whole simulated time, since the search is over-fitted to the searched devices.
//
// Source for giving up candidates: O. Maron & A. W. Moore, "Hoeffding races", NIPS 1993 (the idea; the test here is the median
// of the earlier candidates).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "base/clock.h"
#include "studies/devices/robustness.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_cost.h"

namespace softland {

inline constexpr long default_closings = 60'000;
/// Default waveform family if all devices get the same voltages, and default with a per-device calibration.
inline constexpr std::string_view default_robust_family = "knots", default_calibrated_family = "catch";
inline constexpr std::uint64_t most_searched = 100'000;  ///< largest number of devices of a search, which are all in memory

struct RobustOptions {
  RobustAim aim;
  std::uint64_t samples = 128;                 ///< number of varied devices on which candidate waveforms are tried
  std::uint64_t verdict = 2000;                ///< fresh devices (new to the search) for the final evaluation
  std::function<double()> clock = wall_clock;  ///< clock that measures a time budget [s]
};

struct FulfilledCondition {
  std::string text;    ///< text of the condition on a figure
  Yield share;         ///< share of fresh devices (new to the search) that fulfil the condition
  bool holds = false;  ///< true if constrained_share of the devices fulfil the condition
};
[[nodiscard]] FulfilledCondition fulfilled(const std::vector<DeviceOutcome>& outcomes, const Condition& condition);

/// The findings of a search over varied devices by one measure of risk, as written to JSON.
struct RobustFindings {
  std::string measure;
  /// Number of devices in the search, number of fresh devices (new to the search), and number of closings in the search.
  double devices = Metrics::unset, fresh_devices = Metrics::unset, closings = Metrics::unset;
  double cost_on_searched = Metrics::unset;  ///< cost of the best waveform on the devices of the search
  /// Share of the fresh devices (new to the search) that do not close and stay closed: see fails().
  double failing = Metrics::unset;
  bool is_told = true;  ///< false if the measure of risk says nothing about the waveform, see RobustCost::is_told()
  std::optional<FulfilledCondition> yield;  ///< condition of the yield, if the measure of risk is a yield
  std::vector<FulfilledCondition> conditions;
};

struct RobustResult {
  OptimizeResult found;  ///< best waveform; its costs are over the fresh devices (new to the search)
  /// Results of plain step and best waveform on the same fresh devices (new to the search); none if interrupted.
  std::optional<Robustness> verdict;
  RobustFindings findings;
};

/// Searches for a waveform for varied devices by one measure of risk. `options.max_evaluations` counts closings of devices;
/// `options.optimizer` is not used. Throws InvalidInput as optimize() does, and for a scene without [spread].
[[nodiscard]] RobustResult robust_optimize(const SceneFile& file, const OptimizeOptions& options, const RobustOptions& robust);

/// The parameters that a search will vary, and the height from which on the search counts a rebound.
struct SearchedParameters {
  FamilyColumns columns;
  double significant_rebound = 0;  ///< height from which on a rebound is significant [m]
};
/// Returns the parameters that optimize() would vary, or robust_optimize() if `over_devices`. Throws the exceptions that
/// optimize() or robust_optimize() would throw before the search.
[[nodiscard]] SearchedParameters searched_parameters(const SceneFile& file, const OptimizeOptions& options, bool over_devices,
                                                     const Progress& progress);

}  // namespace softland
