// The whole search for a waveform that varied devices can use: a tournament over devices (tournament), a search on the nominal
// device in parallel, and a final evaluation (verdict) on fresh devices that no stage has used.
//
//   1  A tournament of families and measures (tournament.h), and a choice among its results on 512 other devices, with the plain
//      step. The best candidate so far is reported.
//   2  After a first candidate was evaluated on the 512 devices, the search on the nominal device (optimize.h) for a
//      waveform of the nominal design. The two searches are independent.
//   3  Candidates of the nominal search are compared on 16 devices, the best of them on 64, and the best of these on the 512.
//   4  Searches with a per-device calibration: Vdp to 1 %, and the closing time of one slow step to 50 ns. Vdp and period to
//      0.2 % replace the closing time if the switch is too quick. A calibrated search is repeated under conditions if its
//      result closes harder than the plain step.
//   5  Evaluation on 2000 fresh devices (500 or more if closings are slow): plain step, nominal design's waveform, best waveform
//      and rows with a calibration, over the whole simulated time.
//
// The best waveform, if a drive can move the switch to its contact through stable equilibria (stable_approach.h): candidates
// must not be worse than the plain step, nor leave more than 0.5 % more devices open. Of the candidates that cost at most 5 %
// more than the least, the one with the lowest 95th percentile of impact velocity is the best. Two further choices are reported:
// "fast" is the softest whose devices wait at most half as long for a steady contact as under the plain step, "soft" the
// softest whose devices wait at most twice as long. A choice that equals a faster choice is left out.
//
// The best waveform without such a stable path: candidates must also close within five times the 95th percentile time of the
// plain step (seven times if half the devices are bounce-free). The candidate with most bounce-free devices is the best if at
// least half of its devices are. Otherwise the best is the candidate whose devices touch first, among those that cost at most
// 25 % more than the least.
//
// If the best candidate is worse than the plain step on the fresh devices, the next candidate is evaluated. If all candidates
// are worse, the plain step is the result.
//
// Stages last a number of closings, not a time, so that the result is a function of scene, options and seed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/search/devices_findings.h"
#include "studies/search/robust_search.h"

namespace softland {

/// A waveform that is offered to the user: the default, one with an earlier steady contact, or a softer and slower one.
struct DeviceChoice {
  std::string name;  ///< name of the choice: "fast", "default", "soft"
  ChosenFrom candidate;
  /// 95th percentile of the time until a steady contact, as a multiple of that under the plain step.
  double tau = Metrics::unset;
  DriveRobustness judged = {};
  std::optional<SceneFile> scene = {};  ///< scene with the waveform; set for "fast" and "soft"
};

struct RobustSearchResult {
  /// Scene with the process variation that was used, and with the simulated time of the final evaluation.
  PreparedScene varied;
  OptimizeResult nominal;
  /// The best waveform for the devices, as simulated on the nominal device: the plain step if all other candidates are worse.
  /// best_scene is empty if the search was interrupted before the choice.
  OptimizeResult best;
  std::optional<ChosenFrom> chosen = {};    ///< candidate that became the result; empty if the plain step is best
  std::vector<ChosenFrom> candidates = {};  ///< candidates among which the result was chosen, the best first
  /// Waveforms offered to the user, the waveform with the earliest steady contact first; empty if the plain step is best.
  std::vector<DeviceChoice> choices = {};
  FreeTime free = {};  ///< time that devices may take until contact at no cost in the search
  /// Slow approach by which a drive can move the switch to its contact through stable equilibria; empty if no drive can.
  std::optional<StableApproach> approach = {};
  /// Results on the fresh devices (new to the search) under the plain step, the nominal design's waveform and the best
  /// waveform.
  Robustness verdict = {};
  std::vector<DevicesRow> rows = {};
  /// Scene with the waveform for calibrated devices and the [calibration] that it needs.
  std::optional<SceneFile> calibrated = {};
  double pull_in = Metrics::unset;  ///< dynamic pull-in voltage of the nominal device [V]; set if devices are calibrated
  /// Closing time of the nominal device under the slow step by which devices are calibrated [s].
  double closing_time = Metrics::unset;
  /// Findings for reports; without rows if the search was interrupted before the final evaluation.
  DevicesFindings findings = {};
  bool interrupted = false;

  /// Returns the row for the best waveform in the table of results; call it only after the final evaluation.
  [[nodiscard]] DevicesRow& row_of_devices() {
    return *std::ranges::find(rows, std::string_view(for_the_devices), &DevicesRow::name);
  }
  /// True if the 95th percentile of the rebound height under the plain step, over the fresh devices, is not significant.
  [[nodiscard]] bool plain_step_is_bounce_free() const;
};

/// Runs the search on the nominal device with the options of optimize(), and the search over varied devices; max_seconds is the
/// budget of both together. Calls on_start with the parameters of all searches; those of the tournament begin with
/// tournament_prefix. Throws the exceptions of optimize().
[[nodiscard]] RobustSearchResult robust_search(const SceneFile& file, const OptimizeOptions& options,
                                               const RobustSearchOptions& devices);

}  // namespace softland
