#include "studies/search/paced_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/random.h"
#include "studies/search/tournament.h"

namespace softland {
namespace {

// Rounds (stages) of the search for slow waveforms, with the number of closings of each. Waveforms that last longer than the
// bounces under the plain step get fewer closings, since each takes longer to compute.
constexpr std::array pace_rounds{
    Round{.devices = 64, .closings = 10'000, .step = 0.15}, Round{.devices = 128, .closings = 10'000, .step = 0.1},
    Round{.devices = 256, .closings = 10'000, .step = 0.08}, Round{.devices = 256, .closings = 10'000, .step = 0.04}};

// Share of the permitted time until a steady force that the search uses: on devices that it has not used, the force may be
// steady a little later.
constexpr double of_the_time = 0.995;
using Point = std::vector<double>;
// Number of the first random stream of the quasi-static searches; the tournament of waveform families uses smaller numbers.
constexpr std::uint64_t first_of_paces = 1'000'000;

bool has_pace(const RobustAim& aim) { return aim.free.until > 0 && std::isfinite(aim.free.until); }

// Returns the permitted time until a steady contact force at a pace [s].
double allowed(const Pace& pace, const RobustAim& aim) { return of_the_time * pace.of_step * aim.free.until; }

// Returns the duration of a starting waveform over FreeTime::until, the time until the contact is steady under the plain step.
// The computing time of a closing is proportional to this duration.
double relative_duration(const SearchSetting& setting, const RobustAim& aim) {
  if (!has_pace(aim)) return 1;
  const DriveWaveforms first = setting.space.waveforms(setting.space.starts().front());
  return std::clamp(last_breakpoint(setting.given.commanded(setting.drives(first))) / aim.free.until, 0.5, 4.0);
}

RobustAim aim_at(const Pace& pace, const RobustAim& aim) {
  RobustAim own = aim;
  if (!has_pace(aim)) return own;
  own.free.until = std::numeric_limits<double>::infinity();
  own.conditions.push_back(
      {.figure = figure_of(aim.free.figure), .comparison = Comparison::at_most, .limit = allowed(pace, aim), .text = ""});
  return own;
}

}  // namespace

std::optional<Contender> search_at_pace(const SearchSetting& given, const Pace& pace, const RobustCost& cost,
                                        const RobustAim& aim, SearchBudget& budget, const TournamentOptions& options) {
  const RobustAim own = aim_at(pace, aim);
  SearchSetting setting = given;
  if (has_pace(aim)) setting.space = given.space.paced(allowed(pace, aim));
  const std::uint64_t identity =
      random_bits(options.seed, Stream::tournament, first_of_paces + static_cast<std::uint64_t>(std::lround(16 * pace.of_step)));
  const StagedCost staged(setting, cost, own, options.memory, identity);
  const double length =
      static_cast<double>(options.closings) / static_cast<double>(tournament_closings) / relative_duration(setting, aim);
  Contender found{.family = pace.family, .measure = own.measure.text};
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& start : setting.space.starts()) {
    if (budget.over()) break;
    const StagedCost::Tried tried = staged.tried(start, pace_rounds.front().devices, least, options.jobs);
    found.closings += tried.closings;
    if (tried.cost < least) least = tried.cost, found.x = start;
  }
  if (found.x.empty()) return std::nullopt;
  const auto share = [&](const Round& round, std::size_t) {
    return RoundShare{std::lround(length * round.closings), budget.seconds_left()};
  };
  const auto search = [&](Point& x, SearchInRound turn, Chain chain, SearchBudget& part) {
    chain.seed = random_bits(identity, Stream::tournament, turn.round);
    const ImprovingClosings taken = improve(x, staged, chain, part, [&] {
      if (options.progress) options.progress(0);
    });
    found.closings += taken.before + taken.searched;
  };
  const auto select = [&](const std::vector<Point>& best, std::size_t round) {
    found.x = best.front();
    if (options.on_stage && round + 1 < pace_rounds.size() && !budget.over()) {
      found.waveforms = setting.space.waveforms(found.x);
      options.on_stage(found);
    }
    return best;
  };
  const Tournament<Point> tournament{.budget = budget, .jobs = options.jobs, .share = share, .search = search, .select = select};
  tournament.run(pace_rounds, {found.x});
  found.waveforms = setting.space.waveforms(found.x);
  return found;
}

}  // namespace softland
