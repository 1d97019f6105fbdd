// The family tournament: a tournament (tournament.h) of searches over varied devices, which differ in waveform family and in
// measure of cost.
//
//   round  searches                                              closings of each   devices   first step
//   A      every family by either measure                        2000               32        0.15 of the range
//   B      the best of every family, and the best of the rest    6000               64        0.08
//   C      the best three                                        10 000             128       0.03
//          the first again, if two fifths of the devices are     8000               128       0.03
//          bounce-free, repeated while the share gains 1 %
//
// The measures are the tail of the cost (such as the mean cost of the worst tenth of the devices) and the bounce-free share of
// the devices. If a quarter of the devices close without a rebound after round A, the next rounds are 1.7 times as long, unless
// the number of closings is a fixed budget. Searches by the share use CMA-ES generations of twice the usual size, since the
// share hardly changes between neighbouring points.
//
// The results of the searches are evaluated on the devices of the next round. They are ranked by the share of bounce-free
// devices if the share of any search is a quarter or more (two fifths in the last round). Otherwise they are ranked by the tail
// of the cost, and all searches continue by the tail. A search begins at the best, on 16 devices, of the starts of its family,
// points of the whole search space, and given waveforms.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "studies/search/robust_cost.h"
#include "studies/search/search_budget.h"
#include "studies/search/search_setting.h"

namespace softland {

/// Default waveform families of a family tournament.
inline constexpr std::string_view tournament_families = "knots:6+catch+dual-pulse+bspline:6+staircase:5";
/// Default number of closings in a tournament of five waveform families by two measures.
inline constexpr long tournament_closings = 86'000;
/// Shortest tournament, as a share of tournament_closings: shorter tournaments end too early to be meaningful.
inline constexpr double least_length_of_tournament = 0.25;
/// Number of varied devices of a family tournament. Each search tries its waveforms on the first of these
/// devices, as many as its round has.
inline constexpr std::uint64_t tournament_devices = 256;

/// The two measures of cost that the searches of a family tournament minimise.
struct TournamentAims {
  RobustAim tail;   ///< measure of the tail of the cost distribution, such as cvar:0.9
  RobustAim share;  ///< measure by the share of bounce-free devices
};

/// A search that takes part in a family tournament, and its result so far.
struct Contender {
  std::size_t family = 0;  ///< index of the waveform family among the settings of the tournament
  bool by_share = false;   ///< true: the search minimises TournamentAims::share; false: TournamentAims::tail
  std::string measure = {};
  std::vector<double> x = {};
  DriveWaveforms waveforms = {};  ///< best waveforms of this search for the searched drives [V]
  long closings = 0;              ///< number of simulated closings of this search in all rounds
  double bounce_free = 0;         ///< share of bounce-free devices in the last round of the search
  /// Costs by the measures TournamentAims::tail and TournamentAims::share, on the devices of the comparison after the last round.
  double tail = std::numeric_limits<double>::infinity(), share = std::numeric_limits<double>::infinity();
};

struct TournamentOptions {
  long closings = tournament_closings;  ///< total number of closings of the tournament; its rounds are scaled to this number
  /// True: the tournament never exceeds `closings`; false: it may be longer if many devices are bounce-free.
  bool are_a_budget = false;
  std::uint64_t seed = 1;
  int jobs = 1;  ///< number of threads; does not change the result
  /// Memory of evaluations; may be null. Its keys contain SearchSetting::family, which must therefore differ between settings.
  EvaluationMemory* memory = nullptr;
  std::function<void(double)> progress = {};  ///< called with the share of the tournament that is done, from any thread
  /// Function that is called with the best search at the end of every round (stage) except the last; may be null.
  std::function<void(const Contender&)> on_stage = {};
};

struct TournamentResult {
  std::vector<Contender> contenders;  ///< best searches of all rounds but the first, those of the last round first
  long closings = 0;
};

/// Runs the tournament. `settings` differ only in SearchSetting::family and space; `cost` is for tournament_devices devices. The
/// tournament counts its closings in `budget`, and ends with the budget. `begun` are further waveforms from which searches
/// begin.
[[nodiscard]] TournamentResult family_tournament(const std::vector<SearchSetting>& settings, const RobustCost& cost,
                                                 const TournamentAims& aims, SearchBudget& budget,
                                                 const TournamentOptions& options, const std::vector<DriveWaveforms>& begun = {});

/// Runs a single search, of one waveform family by one measure of risk, through the first three rounds of a tournament. The
/// search may also begin at the waveforms `begun`.
[[nodiscard]] TournamentResult tournament_of_one(const SearchSetting& setting, std::size_t family, const RobustCost& cost,
                                                 const TournamentAims& aims, bool by_share,
                                                 const std::vector<DriveWaveforms>& begun, SearchBudget& budget,
                                                 const TournamentOptions& options);

// A search over varied devices for a quasi-static approach. CMA-ES begins at a closed-form waveform, and uses more devices in
// every round (stage). The pace is given by the time from which on the devices have to carry a steady contact force.

/// The pace of a quasi-static approach, which is the time that the slow closing may take, and the number of its waveform
/// family.
struct Pace {
  double of_step = 1;      ///< permitted time until a steady contact force, as a multiple of that time under the plain step
  std::size_t family = 0;  ///< index of the waveform family among the settings of the search
};

/// Searches the waveforms of a quasi-static approach at a pace. The waveform family of `setting` must be quasi-static. The aim
/// of the whole search, `aim`, holds in its FreeTime the time until a steady force under the plain step. Returns nothing if no
/// waveform of this pace is within the limits, or if the budget ends before a waveform was tried. TournamentOptions::closings
/// scales the number of closings of this search, as in family_tournament().
[[nodiscard]] std::optional<Contender> search_at_pace(const SearchSetting& setting, const Pace& pace, const RobustCost& cost,
                                                      const RobustAim& aim, SearchBudget& budget,
                                                      const TournamentOptions& options);

}  // namespace softland
