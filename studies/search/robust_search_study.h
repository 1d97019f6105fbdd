// The search for a waveform that devices can use: a race over devices, the waveform for the nominal design beside it, and a
// verdict on devices that no stage has seen.
//
//   1  A race over families and measures (race.h), and a choice among what it found on 512 other devices, beside the plain
//      step. The leader is reported on the way.
//   2  From the first look at these devices on, the search on the nominal device (optimize.h): it finds the nominal design's
//      waveform. Neither search needs what the other finds.
//   3  What the nominal search tried, ranked again on 16 devices, the best of it on 64, and these on the devices of the choice.
//   4  Searches with a per-device calibration: Vdp to 1 %, and the closing time of one slow step to 50 ns. Vdp and period to
//      0.2 % take the place of the time for switches that are too quick. A search is repeated under conditions if its result
//      is harder than the plain step.
//   5  Verdict on 2000 fresh devices (500 or more if closings are slow): plain step, nominal design and winner over the whole
//      window. Rows with a calibration use the window of a search, which moves 95th percentiles by less than 0.4 %.
//
// The winner with a stable path: a drive can carry the switch to its contact through stable equilibria (stable_approach.h).
// Candidates must not be worse than the plain step, nor leave more devices open than it does (and half a percent). The winner
// has the softest 95th percentile among those that cost at most a twentieth more than the least. Two choices stand beside it.
// The sooner one is the softest whose devices wait at most half as long for a steady contact as under the plain step. The
// softer one is the softest of those that wait at most twice as long. A choice that a sooner one equals is left out.
//
// The winner without a stable path: candidates must also close in at most five times the 95th percentile time of the plain step
// (seven if half the devices land). The one with most bounce-free devices wins if at least half of them are. Else the one whose
// devices touch first wins among those that cost at most a quarter more than the least.
//
// If the verdict finds the winner worse than the plain step, the next one is judged. If all are worse, the plain step wins.
//
// The stages are counted in closings, so that the result is a function of scene, options and seed.
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

/// Divides one budget of closings: a fifth of options.max_evaluations is for the nominal design, the rest for the race.
void share_budget(OptimizeOptions& options, RobustSearchOptions& devices);

/// A waveform that may be chosen: the default, one whose devices carry a steady force sooner, one that is softer and later.
struct DeviceChoice {
  std::string name;  ///< "fast", "default", "soft"
  ChosenFrom candidate;
  double tau = Metrics::unset;  ///< 95th percentile of the time until a steady contact, over that of the plain step
  DriveRobustness judged = {};
  std::optional<SceneFile> scene = {};  ///< scene of the choice, for fast and soft
};

struct RobustSearchResult {
  PreparedScene varied;  ///< the scene with the spread that is used, over the window of the verdict
  OptimizeResult drawing;
  /// The winner on the nominal device; best_scene is none if the search was interrupted before the choice. The plain step wins
  /// if everything else that was found is worse over the devices.
  OptimizeResult best;
  std::optional<ChosenFrom> chosen = {};        ///< none if the plain step wins
  std::vector<ChosenFrom> candidates = {};      ///< the best first
  std::vector<DeviceChoice> choices = {};       ///< choices, the soonest first; none if the plain step wins
  FreeTime free = {};                           ///< the time until which waiting was not priced
  std::optional<StableApproach> approach = {};  ///< how the switch can be carried to its contact; none if it cannot be
  Robustness verdict = {};                      ///< outcomes of plain step, nominal design and winner
  std::vector<DevicesRow> rows = {};
  std::optional<SceneFile> calibrated = {};  ///< scene with a per-device calibration and its [calibration]
  double pull_in = Metrics::unset;           ///< Vdp of the nominal device, if there is a calibrated waveform [V]
  double closing_time = Metrics::unset;      ///< closing time of the nominal device under the measured step [s]
  DevicesFindings findings = {};             ///< findings; without rows if interrupted before the verdict
  bool interrupted = false;

  /// True if 95 % of the devices have no significant rebound under the plain step.
  [[nodiscard]] bool plain_step_lands() const;
};

/// Searches for the nominal device with the options of optimize(), and over devices; max_seconds is the budget of everything.
/// Throws as optimize() does. on_start is called with the parameters of all searches, those of the race with raced_prefix.
[[nodiscard]] RobustSearchResult robust_search(const SceneFile& file, const OptimizeOptions& options,
                                               const RobustSearchOptions& devices);

}  // namespace softland
