// The search for a waveform that devices can use: a race over devices, the waveform for the nominal design beside it, and a
// verdict on devices that no stage has seen.
//
//   1  a race over families and measures (race.h), and a choice among what it came to on 512 other devices, beside the plain
//      step; what leads on the way is told
//   2  from the first look at these devices on, as neither needs what the other finds, the search on the nominal device
//      (optimize.h): the drawing's waveform
//   3  what the nominal search tried ranked again on 16 devices, the best of it on 64, and these on the devices of the choice
//   4  searches in units that are measured on every device: Vdp to 1 %, and the closing time of one slow step to 50 ns (of
//      switches for which that is no time, Vdp and period to 0.2 %); again, under conditions, where one finds what is harder
//      than the plain step
//   5  verdict on 2000 fresh devices (of slow closings 500 or more): plain step, drawing and winner over the whole window;
//   measured units over that of a search,
//      which moves 95 % quantiles by less than 0.4 %
//
// What wins where a drive can carry the switch to its contact through stable equilibria (stable_approach.h): of the candidates
// that are not worse than the plain step and leave no more devices open than it does (and half a percent), that of the least
// cost; of those that cost at most a twentieth more the softest for 95 % of the devices. Beside it there are a sooner choice, the
// softest of those whose devices wait at most half as long for a steady contact as under the plain step, and a softer one, of
// those that wait at most twice as long. A choice that a sooner one equals is left out.
//
// What wins where no drive can: of the candidates that also close in at most five times the 95 % time of the plain step (seven
// where half the devices land), the one with most devices that land without a rebound, where that is at least half of them; else,
// of those that cost at most a quarter more than the least, the one whose devices touch first.
//
// Where the verdict finds the winner worse than the plain step the next one is judged; where all are, the plain step wins.
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
#include "studies/search/devices_search.h"

namespace softland {

/// Shares a budget of closings, which is that of everything together: a fifth of options.max_evaluations is for the drawing, the
/// rest for the race.
void share_budget(OptimizeOptions& options, ForDevicesOptions& devices);

/// A waveform that may be chosen: the default, one whose devices carry a steady force sooner, one that is softer and later.
struct DeviceChoice {
  std::string name;  ///< "fast", "default", "soft"
  ChosenFrom candidate;
  double tau = Metrics::unset;  ///< what its devices wait for a steady contact over what they wait under the plain step, on 95 %
  DriveRobustness judged = {};
  std::optional<SceneFile> scene = {};  ///< of fast and soft
};

struct ForDevicesResult {
  PreparedScene varied;  ///< the scene with the spread that was looked at, over the window of the verdict
  OptimizeResult drawing;
  /// On the nominal device: the waveform that wins; best_scene is none where the search was interrupted before the choice.
  /// The plain step wins where all that was found is worse over the devices.
  OptimizeResult best;
  std::optional<ChosenFrom> chosen = {};        ///< none where the plain step wins
  std::vector<ChosenFrom> candidates = {};      ///< the best first
  std::vector<DeviceChoice> choices = {};       ///< by time: the soonest first; none where the plain step wins
  FreeTime free = {};                           ///< until when waiting was not priced
  std::optional<StableApproach> approach = {};  ///< how the switch can be carried to its contact; none where it cannot be
  Robustness verdict = {};                      ///< of plain step, drawing and winner
  std::vector<DevicesRow> rows = {};
  std::optional<SceneFile> calibrated = {};  ///< in units that are measured on every device, with its [calibration]
  double pull_in = Metrics::unset;           ///< Vdp of the nominal device, where there is a calibrated waveform [V]
  double closing_time = Metrics::unset;      ///< of the nominal device, under the step that is measured [s]
  DevicesFindings findings = {};             ///< without rows where the search was interrupted before the verdict
  bool interrupted = false;

  /// Whether 95 % of the devices rebound by no more than what counts under the plain step.
  [[nodiscard]] bool plain_step_lands() const;
};

/// Options of the nominal search as optimize(), whose max_seconds is that of everything. Throws as
/// optimize() does. on_start hears of the parameters of all searches, those of the race with raced_prefix.
[[nodiscard]] ForDevicesResult optimize_for_devices(const SceneFile& file, const OptimizeOptions& options,
                                                    const ForDevicesOptions& devices);

}  // namespace softland
