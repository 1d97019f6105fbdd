#include "studies/search/family_tournament.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "base/executor.h"
#include "base/random.h"
#include "studies/devices/robustness.h"
#include "studies/search/tournament.h"

namespace softland {
namespace {

using Point = std::vector<double>;

// Rounds (stages) of a tournament of searches. The numbers of closings are those of each search in a tournament of default
// length. The last two rounds continue only the best search.
constexpr std::array family_rounds{Round{.devices = 32, .closings = 2000, .step = 0.15},
                                   Round{.devices = 64, .closings = 6000, .step = 0.08},
                                   Round{.contenders = 3, .devices = 128, .closings = 10'000, .step = 0.03},
                                   Round{.contenders = 1, .devices = 128, .closings = 8000, .step = 0.03},
                                   Round{.contenders = 1, .devices = 128, .closings = 8000, .step = 0.03}};
constexpr std::size_t usual_rounds = 3;
// Searches are ranked by their bounce-free share of devices if any of them has at least this share: enough_land after the first
// round, many_land after later ones. Only from many_land on is the best search continued beyond the usual three rounds.
constexpr double enough_land = 0.25, many_land = 0.4;
// The best search is continued once more if its last round has raised its bounce-free share by more than this.
constexpr double worth_going_on = 0.01;
constexpr double population_by_share = 2, longer_where_many_land = 1.7;
constexpr std::size_t first_devices = 16;  // number of devices on which starting points are tried
constexpr std::uint64_t box_points = 32;

// Returns the number of closings of one search in the rounds (stages) `first` to `last` - 1 of a tournament of default length.
double closings_of_rounds(std::size_t first, std::size_t last) {
  double all = 0;
  for (std::size_t k = first; k < last; ++k) all += family_rounds[k].closings;
  return all;
}

class FamilyTournament {
 public:
  FamilyTournament(const std::vector<SearchSetting>& settings, const RobustCost& cost, const TournamentAims& aims,
                   SearchBudget& budget, const TournamentOptions& options)
      : settings_(settings), cost_(cost), aims_(aims), options_(options), budget_(budget, options.closings) {}

  /// Runs a tournament between the searches `contenders`, or, if `alone`, the three usual rounds of a single search. `begun`
  /// are further waveforms at which the searches may begin.
  TournamentResult run(std::vector<Contender> contenders, const std::vector<DriveWaveforms>& begun, bool alone) {
    alone_ = alone;
    length_ = static_cast<double>(options_.closings) / static_cast<double>(tournament_closings);
    if (length_ < least_length_of_tournament) return {};
    longer_ = alone || options_.are_a_budget ? length_ : longer_where_many_land * length_;
    if (alone) budget_.allow(std::lround(length_ * closings_of_rounds(0, usual_rounds)));
    begin(contenders, begun);
    std::erase_if(contenders, [](const Contender& r) { return r.x.empty(); });
    const auto share = [this](const Round& round, std::size_t) {
      return RoundShare{static_cast<long>((many_ ? longer_ : length_) * round.closings), budget_.seconds_left()};
    };
    const Tournament<Contender> tournament{
        .budget = budget_,
        .jobs = options_.jobs,
        .share = share,
        .search = [this](Contender& r, SearchInRound turn, const Chain& chain,
                         SearchBudget& part) { search(r, turn.round, chain, part); },
        .select = [this](std::vector<Contender> all, std::size_t k) { return select(std::move(all), k); }};
    tournament.run(family_rounds, std::move(contenders));
    std::ranges::reverse(result_.contenders);
    result_.closings = budget_.taken();
    return std::move(result_);
  }

 private:
  [[nodiscard]] const SearchSetting& setting(const Contender& r) const { return settings_[r.family]; }
  [[nodiscard]] const RobustAim& aim(const Contender& r) const { return r.by_share ? aims_.share : aims_.tail; }
  // Returns the number that stands for the random devices, and for the measure of risk and conditions of a search, in the keys
  // of the memory of evaluations.
  [[nodiscard]] std::uint64_t identity(const Contender& r) const {
    return random_bits(options_.seed, Stream::tournament, r.by_share ? 1 : 0);
  }

  void tell() const {
    if (options_.progress) options_.progress(budget_.share_taken());
  }

  // Sets the starting point of every search to the best of many starts, by the measure of risk that this search minimises.
  void begin(std::vector<Contender>& contenders, const std::vector<DriveWaveforms>& begun) {
    std::map<std::size_t, std::vector<Point>> starts;  // starting points of each waveform family
    for (const Contender& r : contenders) {
      if (starts.contains(r.family)) continue;
      std::vector<Point>& own = starts[r.family] = starting_points(setting(r), begun);
      std::ranges::move(points_of_box(setting(r).space.variables(), options_.seed, box_points), std::back_inserter(own));
      budget_.allow(budget_.left() + static_cast<long>(first_devices * own.size()));
    }
    for (const auto& [family, points] : starts) {
      std::vector<std::vector<DeviceOutcome>> outcomes(points.size());
      run_tasks(
          points.size(), options_.jobs,
          [&](std::size_t i) { outcomes[i] = closed(settings_[family], points[i], first_devices, 1); }, budget_.stop());
      for (Contender& r : contenders) {
        if (r.family != family) continue;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < points.size(); ++i) {
          if (outcomes[i].empty()) continue;
          const double value = cost_.value(outcomes[i], aim(r));
          if (value < least) least = value, r.x = points[i];
        }
      }
    }
  }

  // Simulates the first `devices` devices at the point `x`. Returns no outcomes if the waveform exceeds a limit of a voltage
  // source.
  std::vector<DeviceOutcome> closed(const SearchSetting& own, const Point& x, std::size_t devices, int jobs) {
    const DriveWaveforms searched = own.space.waveforms(x);
    if (!own.is_allowed(searched)) return {};
    std::vector<DeviceOutcome> outcomes = cost_.close(own.drives(searched), 0, std::min(devices, cost_.devices()), jobs);
    budget_.took(static_cast<long>(outcomes.size()));
    tell();
    return outcomes;
  }

  void search(Contender& r, std::size_t round, Chain chain, SearchBudget& part) const {
    const StagedCost staged(setting(r), cost_, aim(r), options_.memory, identity(r));
    chain.population = r.by_share && !alone_ ? population_by_share : 1;
    chain.seed = random_bits(options_.seed, Stream::tournament, 1000 * round + 2 * r.family + (r.by_share ? 1 : 0));
    r.closings += improve(r.x, staged, chain, part, [this] { tell(); }).searched;
  }

  // Compares the searches after round `k` of the tournament, and returns the searches that continue in the next round.
  std::vector<Contender> select(std::vector<Contender> contenders, std::size_t k) {
    const double before = contenders.front().bounce_free;
    judge(contenders, family_rounds[std::min(k + 1, family_rounds.size() - 1)].devices);
    if (k > 0)
      std::ranges::transform(contenders, std::back_inserter(result_.contenders),
                             [this](const Contender& r) { return described(r); });
    if (k >= usual_rounds)
      return contenders.front().bounce_free > before + worth_going_on ? contenders : std::vector<Contender>();
    many_ =
        std::ranges::any_of(contenders, [&](const Contender& r) { return r.bounce_free >= (k == 0 ? enough_land : many_land); });
    if (k == 0 && many_) plan_longer();
    if (!alone_)
      contenders = k == 0 ? survivors(std::move(contenders)) : best(std::move(contenders), family_rounds[k + 1].contenders);
    if (k + 1 == usual_rounds) return many_ && !alone_ ? contenders : std::vector<Contender>();
    if (alone_) return contenders;
    if (options_.on_stage && !budget_.over())
      options_.on_stage(described(*std::ranges::min_element(contenders, {}, rank_by(many_))));
    for (Contender& r : contenders) r.by_share = r.by_share && many_;
    return contenders;
  }

  // Extends the budget of closings after a first round with many bounce-free devices: the next rounds are longer, and the best
  // search is then continued.
  void plan_longer() {
    const double again = alone_ ? 0 : closings_of_rounds(usual_rounds, family_rounds.size());
    const double left = longer_ / length_ * static_cast<double>(budget_.left()) + longer_ * again;
    budget_.allow(budget_.taken() + std::lround(left));
  }

  // Computes, for the best point of every search, both costs (TournamentAims::tail and TournamentAims::share) and the bounce-free
  // share, on the first `devices` devices.
  void judge(std::vector<Contender>& contenders, std::size_t devices) {
    run_tasks(
        contenders.size(), options_.jobs,
        [&](std::size_t i) {
          Contender& r = contenders[i];
          const std::vector<DeviceOutcome> outcomes = closed(setting(r), r.x, devices, options_.jobs);
          r.bounce_free =
              static_cast<double>(std::ranges::count_if(outcomes, is_bounce_free)) / static_cast<double>(outcomes.size());
          r.tail = cost_.value(outcomes, aims_.tail);
          r.share = cost_.value(outcomes, aims_.share);
        },
        budget_.stop());
  }

  // Returns the cost by which searches are ranked, as a member of Contender: that by TournamentAims::share, or that by
  // TournamentAims::tail.
  static double Contender::*rank_by(bool share) { return share ? &Contender::share : &Contender::tail; }

  // Returns the best search of every waveform family by one of two costs (TournamentAims::tail or TournamentAims::share, see
  // rank_by()), and, of all other searches, the best one by the other cost.
  [[nodiscard]] std::vector<Contender> survivors(std::vector<Contender> contenders) const {
    std::ranges::stable_sort(contenders, {}, rank_by(many_));
    std::vector<Contender> kept, others;
    std::set<std::size_t> families;
    for (Contender& r : contenders) (families.insert(r.family).second ? kept : others).push_back(std::move(r));
    if (!others.empty()) kept.push_back(*std::ranges::min_element(others, {}, rank_by(!many_)));
    return kept;
  }

  [[nodiscard]] std::vector<Contender> best(std::vector<Contender> contenders, std::size_t count) const {
    std::ranges::stable_sort(contenders, {}, rank_by(many_));
    contenders.resize(std::min(contenders.size(), count));
    return contenders;
  }

  [[nodiscard]] Contender described(Contender r) const {
    r.measure = aim(r).measure.text;
    r.waveforms = setting(r).space.waveforms(r.x);
    return r;
  }

  const std::vector<SearchSetting>& settings_;
  const RobustCost& cost_;
  const TournamentAims& aims_;
  const TournamentOptions& options_;
  SearchBudget budget_;  // budget of closings that the tournament may simulate
  // Number of closings of the tournament over the default number: in general, and if many devices are bounce-free.
  double length_ = 1, longer_ = 1;
  bool alone_ = false;  // true: a single search, not a tournament
  bool many_ = false;   // true: many devices are bounce-free after the latest round, so that searches are ranked by this share
  TournamentResult result_;
};

// Rounds (stages) of the search for slow waveforms, with the number of closings of each. Waveforms that last longer than the
// bounces under the plain step get fewer closings, since each takes longer to compute.
constexpr std::array pace_rounds{
    Round{.devices = 64, .closings = 10'000, .step = 0.15}, Round{.devices = 128, .closings = 10'000, .step = 0.1},
    Round{.devices = 256, .closings = 10'000, .step = 0.08}, Round{.devices = 256, .closings = 10'000, .step = 0.04}};

// Share of the permitted time until a steady force that the search uses: on devices that it has not used, the force may be
// steady a little later.
constexpr double of_the_time = 0.995;
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

TournamentResult family_tournament(const std::vector<SearchSetting>& settings, const RobustCost& cost, const TournamentAims& aims,
                                   SearchBudget& budget, const TournamentOptions& options,
                                   const std::vector<DriveWaveforms>& begun) {
  std::vector<Contender> contenders;
  for (std::size_t family = 0; family < settings.size(); ++family) {
    for (const bool by_share : {false, true}) contenders.push_back({.family = family, .by_share = by_share});
  }
  return FamilyTournament(settings, cost, aims, budget, options).run(std::move(contenders), begun, false);
}

TournamentResult tournament_of_one(const SearchSetting& setting, std::size_t family, const RobustCost& cost,
                                   const TournamentAims& aims, bool by_share, const std::vector<DriveWaveforms>& begun,
                                   SearchBudget& budget, const TournamentOptions& options) {
  const std::vector<SearchSetting> settings{setting};
  TournamentResult found = FamilyTournament(settings, cost, aims, budget, options).run({{.by_share = by_share}}, begun, true);
  for (Contender& r : found.contenders) r.family = family;
  return found;
}

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
