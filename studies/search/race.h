// A race over devices: a tournament (tournament.h) of searches of several families by two measures.
//
//   round  searches                                              closings of each   devices   first step
//   A      every family by either measure                        2000               32        0.15 of the box
//   B      the best of every family, and the best of the rest    6000               64        0.08
//   C      the best three                                        10 000             128       0.03
//          the first again, if two fifths of the devices are     8000               128       0.03
//          bounce-free, as long as that gains 1 %
//
// If a quarter of the devices close without a rebound after A, the next rounds are 1.7 times as long, unless the closings are
// a budget. Searches by the share have generations twice as large as those of a single search: the share takes few values, so
// that it hardly changes between neighbouring points.
//
// The searches are judged on the devices of the next round. They are ranked by the share of bounce-free devices if any search
// reaches a quarter there (two fifths in the last round), else by the tail of the cost. In the latter case all of them go on by
// the tail. A search begins at the best of its family's own starts, of points of the whole box, and of the given waveforms, on
// 16 devices.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "studies/search/robust_cost.h"
#include "studies/search/search_budget.h"
#include "studies/search/search_setting.h"

namespace softland {

/// Families of a race if none is named.
inline constexpr std::string_view raced_families = "knots:6+catch+dual-pulse+bspline:6+staircase:5";
/// Closings of a race of five families by two measures.
inline constexpr long race_closings = 86'000;
/// The least length of a race, over the default one: shorter searches end too early to be meaningful.
inline constexpr double least_length_of_race = 0.25;
/// Most devices of a race.
inline constexpr std::uint64_t raced_devices = 256;

/// The two measures of a race.
struct RaceAims {
  RobustAim tail;   ///< tail of the cost, as cvar:0.9
  RobustAim share;  ///< share of bounce-free devices
};

/// The result of a search of the race.
struct Contender {
  std::size_t family = 0;  ///< its number among the settings
  bool by_share = false;   ///< searched by RaceAims::share
  std::string measure = {};
  std::vector<double> x = {};
  DriveWaveforms waveforms = {};  ///< waveforms of the searched drives [V]
  long closings = 0;              ///< closings of the searches that led to it
  double bounce_free = 0;         ///< bounce-free share of the devices of its last round
  double tail = std::numeric_limits<double>::infinity(), share = std::numeric_limits<double>::infinity();  ///< its costs there
};

struct RaceOptions {
  long closings = race_closings;  ///< closings; they scale the rounds
  bool are_a_budget = false;      ///< true: rounds do not become longer if many devices close without a rebound
  std::uint64_t seed = 1;
  int jobs = 1;                               ///< threads; does not change the result
  EvaluationMemory* memory = nullptr;         ///< its keys hold SearchSetting::family, which has to differ
  std::function<void(double)> progress = {};  ///< called with the part that is done, from any thread
  /// Called with the best search at the end of every round but the last; may be null.
  std::function<void(const Contender&)> on_stage = {};
};

struct RaceResult {
  std::vector<Contender> contenders;  ///< winners of all rounds, the last round first
  long closings = 0;
};

/// Runs the race. `settings` differ in SearchSetting::family and space alone; `cost` is on raced_devices devices. The race
/// counts its closings in `budget`, and ends when that is over. `begun` are further waveforms to begin with.
[[nodiscard]] RaceResult race(const std::vector<SearchSetting>& settings, const RobustCost& cost, const RaceAims& aims,
                              SearchBudget& budget, const RaceOptions& options, const std::vector<DriveWaveforms>& begun = {});

/// Runs one search through all rounds, of one family by one measure. `begun` are further waveforms to begin with.
[[nodiscard]] RaceResult race_single_search(const SearchSetting& setting, std::size_t family, const RobustCost& cost,
                                            const RaceAims& aims, bool by_share, const std::vector<DriveWaveforms>& begun,
                                            SearchBudget& budget, const RaceOptions& options);

}  // namespace softland
