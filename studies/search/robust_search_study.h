// The whole search for a waveform that varied devices can use: a race over devices, a search on the nominal device in parallel,
// and a verdict on fresh devices that no stage has used.
//
//   1  A race over families and measures (race.h), and a choice among its results on 512 other devices, with the plain
//      step. The best candidate so far is reported.
//   2  As soon as a first candidate was judged on the 512 devices, the search on the nominal device (optimize.h) for a
//      waveform of the nominal design. The two searches are independent.
//   3  Candidates of the nominal search are ranked on 16 devices, the best of them on 64, and the best of these on the 512.
//   4  Searches with a per-device calibration: Vdp to 1 %, and the closing time of one slow step to 50 ns. Vdp and period to
//      0.2 % replace the closing time if the switch is too quick. Such a search is repeated under conditions if its result
//      is harder than the plain step.
//   5  Verdict on 2000 fresh devices (500 or more if closings are slow): plain step, nominal design and winner over the whole
//      window. Rows with a calibration use the window of a search, which moves 95th percentiles by less than 0.4 %.
//
// The winner, if a drive can carry the switch to its contact through stable equilibria (stable_approach.h): candidates must not
// be worse than the plain step, nor leave more than 0.5 % more devices open. The winner has the lowest 95th percentile of
// impact speed among candidates that cost at most 5 % more than the least. Two further choices are reported: "fast" is the
// softest whose devices wait at most half as long for a steady contact as under the plain step, "soft" the softest whose
// devices wait at most twice as long. A choice that equals a faster choice is left out.
//
// The winner without such a stable path: candidates must also close within five times the 95th percentile time of the plain
// step (seven times if half the devices are bounce-free). The candidate with most bounce-free devices wins if at least half of
// its devices are. Otherwise the candidate whose devices touch first wins, among those that cost at most 25 % more than the
// least.
//
// If the winner is worse than the plain step on the fresh devices, the next candidate is judged. If all candidates are worse,
// the plain step wins.
//
// Stages last a number of closings, not a time, so that the result is a function of scene, options and seed.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/search/devices_findings.h"
#include "studies/search/robust_search.h"

namespace softland {

/// A waveform that the user may choose: the default, one with a quicker steady contact, or a softer and slower one.
struct DeviceChoice {
  std::string name;  ///< "fast", "default", "soft"
  ChosenFrom candidate;
  double tau = Metrics::unset;  ///< 95th percentile of the time until a steady contact, relative to the plain step
  DriveRobustness judged = {};
  std::optional<SceneFile> scene = {};  ///< scene with the waveform, for "fast" and "soft"
};

struct RobustSearchResult {
  PreparedScene varied;  ///< the scene with the spread that is used, over the window of the verdict
  OptimizeResult drawing;
  /// The winner on the nominal device: the plain step if all other candidates are worse over the devices. Without best_scene if
  /// the search was interrupted before the choice.
  OptimizeResult best;
  std::optional<ChosenFrom> chosen = {};    ///< none if the plain step wins
  std::vector<ChosenFrom> candidates = {};  ///< candidates of the choice, the best first
  std::vector<DeviceChoice> choices = {};   ///< choices, the quickest to a steady contact first; none if the plain step wins
  FreeTime free = {};                       ///< the time until contact that cost nothing
  std::optional<StableApproach> approach =
      {};                   ///< how the switch can be carried to its contact through stable equilibria; none if it cannot
  Robustness verdict = {};  ///< plain step, nominal design's waveform and winner on the fresh devices
  std::vector<DevicesRow> rows = {};
  std::optional<SceneFile> calibrated = {};  ///< scene with the waveform for calibrated devices and its [calibration]
  double pull_in = Metrics::unset;           ///< dynamic pull-in voltage of the nominal device, if devices are calibrated [V]
  double closing_time = Metrics::unset;      ///< closing time of the nominal device under the measured step [s]
  DevicesFindings findings = {};             ///< findings for reports; without rows if interrupted before the verdict
  bool interrupted = false;

  /// Returns the row of the winner over the devices; call only after the verdict.
  [[nodiscard]] DevicesRow& row_of_devices();
  /// True if 95 % of the devices have no significant rebound under the plain step.
  [[nodiscard]] bool plain_step_lands() const;
};

/// Runs the search on the nominal device with the options of optimize(), and the search over varied devices; max_seconds is the
/// budget of both. Calls on_start with the parameters of all searches; those of the race begin with raced_prefix. Throws what
/// optimize() throws.
[[nodiscard]] RobustSearchResult robust_search(const SceneFile& file, const OptimizeOptions& options,
                                               const RobustSearchOptions& devices);

}  // namespace softland
