// The search for a drive that does well on devices with the process variation of manufacturing.
//
// All candidates are tried on the same devices. Starts are those of the family, the best of two searches on the nominal device,
// the waveform of the scene, the given waveforms, and points of the whole box. All are tried on 8 devices, the best of them on
// 32, and the best six of these begin CMA-ES on 32 devices. It goes on from the best two on all devices, and then from the
// best, by smaller steps. A candidate that is worse on the first 8 or 32 devices than the median of those before it is not
// tried on the rest, and has the cost of those. The best point of every round is compared on 512 other devices. The winner is
// judged on 2000 fresh ones over the whole window: its cost on the searched devices is too good, as the search is over-fitted
// to them.
//
// Source for the races: O. Maron & A. W. Moore, "Hoeffding races", NIPS 1993 (the idea; our test is the median of the candidates
// before).
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
/// Families searched if none is named: with the same volts for all devices, and with a per-device calibration.
inline constexpr std::string_view default_robust_family = "knots", default_calibrated_family = "catch";
inline constexpr std::uint64_t most_searched = 100'000;  ///< most devices of a search, which are all kept

struct RobustOptions {
  RobustAim aim;
  std::uint64_t samples = 128;                 ///< searched devices
  std::uint64_t verdict = 2000;                ///< fresh devices
  std::function<double()> clock = wall_clock;  ///< clock of a budget of time [s]
};

struct FulfilledCondition {
  std::string text;    ///< text of the condition
  Yield share;         ///< share of fresh devices that fulfil it
  bool holds = false;  ///< true if constrained_share of them fulfil it
};
[[nodiscard]] FulfilledCondition fulfilled(const std::vector<DeviceOutcome>& outcomes, const Condition& condition);

/// The findings of a search over devices by one measure, as its JSON holds them.
struct RobustFindings {
  std::string measure;
  double devices = Metrics::unset, fresh_devices = Metrics::unset, closings = Metrics::unset;  ///< closings: in the search
  double cost_on_searched = Metrics::unset;  ///< cost of the winner on the searched devices
  double failing = Metrics::unset;  ///< share of the fresh devices that end open, are not kept closed, or are outside the model
  bool is_told = true;              ///< the measure looks beyond those
  std::optional<FulfilledCondition> yield;  ///< condition of a yield
  std::vector<FulfilledCondition> conditions;
};

struct RobustResult {
  OptimizeResult found;               ///< costs are those on fresh devices
  std::optional<Robustness> verdict;  ///< plain step and winner on the same fresh devices; none if interrupted
  RobustFindings findings;
};

/// `options.max_evaluations` counts closings of devices; its optimizer is not used. Throws InvalidInput as optimize() does, and
/// for a scene without [spread].
[[nodiscard]] RobustResult robust_optimize(const SceneFile& file, const OptimizeOptions& options, const RobustOptions& robust);

/// The parameters that a search will vary, and the height from which on a rebound counts.
struct SearchedParameters {
  FamilyColumns columns;
  double significant_rebound = 0;  ///< [m]
};
/// Returns those of optimize(), or of robust_optimize() if `over_devices`. Throws what these would throw before they begin.
[[nodiscard]] SearchedParameters searched_parameters(const SceneFile& file, const OptimizeOptions& options, bool over_devices,
                                                     const Progress& progress);

}  // namespace softland
