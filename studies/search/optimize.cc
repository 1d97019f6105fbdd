#include "studies/search/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "base/random.h"
#include "studies/closing/plain_step.h"
#include "studies/search/evaluation_log.h"
#include "studies/search/family_search.h"
#include "studies/search/least_time.h"
#include "studies/search/search_budget.h"
#include "studies/search/search_setting.h"
#include "studies/search/searched_families.h"
#include "studies/search/tournament.h"
#include "studies/search/verification.h"

namespace softland {
namespace {

// For a target with a cost other than that of bounce: number of further candidates of each waveform family that are verified,
// those most likely to close without a bounce.
constexpr std::size_t most_sure = 4;
// Number of further candidates of each waveform family that are verified if no candidate was confirmed so far.
constexpr std::size_t most_of_family = 4;
// Least budget of evaluations for which the search computes starting waveforms that reach the contact at rest, which takes
// long.
constexpr long fewest_for_landings = 1000;
// Least time budget for which the search computes starting waveforms that reach the contact at rest [s].
constexpr double least_for_landings = 60;
// Shares of a time budget at which three parts of a search end: the search, its continuation with slower voltage edges, and its
// continuation by the worst cost over several numbers of modes. The rest is for verifying the best waveform.
constexpr double end_of_search = 0.6, end_of_gentle = 0.75, end_of_worst = 0.85;
// Permitted impact velocity of starting waveforms that reach the contact nearly at rest, as a share of that under the plain
// step.
constexpr double soft_touch = 0.01;
// Number of waveform families whose search is continued by the worst cost over the scene's number of modes and more modes.
constexpr std::size_t families_sifted = 2;
// The search by the worst cost over several numbers of modes gets the budget of evaluations divided by this number.
constexpr long evaluations_of_the_worst = 50;
constexpr long shortest_half = 100;  // fewest evaluations of each half of a divided budget
// Share of the budget that all waveform families get in equal parts first; the best family then gets the rest.
constexpr double opening = 0.6;

// The search on the nominal device in all its waveform families, with its log of evaluations.
class RunningSearch {
 public:
  /// Setting k is that of the waveform family with the number k. The search may use `seconds` [s] of the time of the budget
  /// `whole`.
  RunningSearch(const std::vector<SearchSetting>& settings, const OptimizeOptions& options, SearchBudget& whole, double seconds)
      : settings_(settings),
        options_(options),
        budget_(whole, options.max_evaluations, seconds),
        log_(options, budget_, settings.front().baseline_cost,
             [this](const Evaluation& e) { return e.value < never_touched ? settings_[e.problem].scene_at(e.x) : std::nullopt; }),
        names_(families_of(options.family)) {
    for (const SearchSetting& setting : settings) {
      families_.emplace_back(setting, options, [this](const Evaluation& e) {
        budget_.took(1);
        log_.note(e);
      });
    }
  }

  // Adds the scene's own waveforms and those of OptimizeOptions::starts as first candidates, and as starts of every waveform
  // family, at the nearest point of the family.
  void begin() {
    const SearchSetting& setting = settings_.front();
    if (!setting.starts_as_step())
      refine(setting.given.signals(), setting.given.drives.waveforms(),
             [&] { return prepared_with(setting.given, {}, setting.given); });
    for (const StartingWaveforms& start : options_.starts) {
      const DriveWaveforms searched = setting.space.searched(start.waveforms);
      refine(setting.given.applied(setting.drives(searched)), searched, [&] { return setting.prepared(searched); });
    }
    if (!is_divided(options_.max_evaluations)) begin_at_rest();
    for (const auto& swing : joint_rest_to_rest_starts(setting.given, setting.space)) {
      for (FamilySearch& family : families_) {
        if (family.point(swing)) family.begin_at(swing);
      }
    }
  }

  void begin_at_rest() {
    for (const auto& landing : rest_to_rest_starts()) {
      for (FamilySearch& family : families_) family.begin_at(landing);
    }
  }

  // Adds the starting point `x` to the first waveform family.
  void begin_at_point(const std::vector<double>& x) { families_.front().begin_at_point(x); }

  // Returns starting waveforms that reach the contact with all modes at rest, for a piezo or several drives and a large enough
  // budget; otherwise none.
  [[nodiscard]] std::vector<DriveWaveforms> rest_to_rest_starts() const {
    const SearchSetting& setting = settings_.front();
    const std::vector<DriveSearch>& shaped = setting.space.drives();
    const bool can_rest = shaped.size() > 1 || shaped.front().drive == piezo_drive;
    if (!can_rest || options_.max_evaluations < fewest_for_landings || budget_.seconds() < least_for_landings) return {};
    return softland::rest_to_rest_starts(setting.within_limits(), options_.actuator,
                                         soft_touch * setting.scale.step.largest_impact_velocity,
                                         {.stop = options_.stop, .report = options_.on_preparation});
  }

  OptimizerResult run() {
    run_halves(options_.max_evaluations);
    return all_;
  }

  // Verifies the user's waveforms and the best candidates of the search, until no further candidate can be better.
  void check(Verification& all) const {
    for (const FoundWaveform& given : landings_) all.add(given);
    std::vector<Evaluation> tried;
    const auto add = [&](const Evaluation& e) {
      tried.push_back(e);
      all.add(found(e));
    };
    for (const Evaluation& e : candidates(all_.improvements)) {
      add(e);
      if (all.decided(e.value)) break;
    }
    // If no candidate is confirmed, verify candidates of every waveform family: those of one family excite the same modes,
    // which the scene neglects.
    for (std::size_t k = 0; k < families_.size() && families_.size() > 1 && !all.confirmed(); ++k) {
      std::size_t added = 0;
      for (const Evaluation& e : candidates(improvements_of(log_.evaluations(k)))) {
        if (added == most_of_family || all.decided(e.value)) break;
        if (std::ranges::find(tried, e.index, &Evaluation::index) != tried.end()) continue;
        add(e);
        ++added;
      }
    }
    // For a target whose cost differs from that of bounce, verify further candidate waveforms whose target cost is below that
    // of the best verified one, those with the least bounce cost (guide cost) first.
    if (options_.target.has_own_cost()) {
      for (const FamilySearch& family : families_) {
        for (std::size_t k = 0; k < most_sure; ++k) {
          const std::optional<Evaluation> e = family.surest_below(all.best_cost() / distinct, tried);
          if (!e || !(e->value < never_touched)) break;
          add(*e);
        }
      }
    }
  }

  // Candidate waveforms of one waveform family, ranked by a cost: their points, and the least cost.
  struct Promising {
    std::size_t family = 0;
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::vector<double>> points = {};
  };

  // Ranks the candidate waveforms of every waveform family by their cost in `other`, a setting with several numbers of modes.
  // The family with the least cost comes first.
  [[nodiscard]] std::vector<Promising> promising(const SearchSetting& other) const {
    std::vector<Promising> all;
    for (std::size_t k = 0; k < families_.size(); ++k) {
      std::vector<std::pair<double, std::vector<double>>> own;
      for (const Evaluation& e : candidates(improvements_of(log_.evaluations(k)))) {
        const DriveWaveforms waveforms = families_[k].waveforms(e);
        own.emplace_back(other.price(other.given.applied(other.drives(waveforms))).target, e.x);
      }
      if (own.empty()) continue;
      std::ranges::stable_sort(own, {}, &std::pair<double, std::vector<double>>::first);
      all.push_back({.family = k, .least = own.front().first});
      for (auto& [cost, point] : own) all.back().points.push_back(std::move(point));
    }
    std::ranges::stable_sort(all, {}, &Promising::least);
    return all;
  }

  [[nodiscard]] std::vector<TriedWaveform> tried() const {
    std::vector<TriedWaveform> kept;
    for (const Evaluation& e : log_.sampled_by_rank(families_.size()))
      kept.push_back({.family = names_[e.problem], .cost = e.value, .waveforms = families_[e.problem].waveforms(e)});
    return kept;
  }

  // Returns the results of the search in every waveform family.
  [[nodiscard]] std::vector<SearchedFamilyResult> families() const {
    std::vector<SearchedFamilyResult> all;
    for (std::size_t k = 0; k < families_.size(); ++k) {
      const std::optional<GuidedSearch::Best> best = families_[k].best(Costs::target);
      all.push_back({.family = names_[k],
                     .evaluations = static_cast<long>(log_.evaluations(k).size()),
                     .cost = best ? best->cost : std::numeric_limits<double>::quiet_NaN()});
    }
    return all;
  }

 private:
  [[nodiscard]] bool is_divided(long evaluations) const {
    return options_.begins_with_half && !std::isfinite(budget_.seconds()) && evaluations >= 2 * shortest_half;
  }

  // Runs the search. With OptimizeOptions::begins_with_half, runs the search with half the budget first, and then spends the
  // other half. Returns false if the search was interrupted or failed.
  bool run_halves(long evaluations) {
    if (!is_divided(evaluations)) return run_undivided(evaluations);
    const long half = evaluations / 2;
    if (!run_halves(half)) return false;
    if (half < fewest_for_landings && evaluations >= fewest_for_landings) begin_at_rest();
    return run_undivided(evaluations - half);
  }

  bool run_undivided(long evaluations) {
    const bool has_own = options_.target.has_own_cost();
    const double all_seconds = std::max(budget_.seconds_left(), budget_.seconds() / 4);
    const long before = all_.evaluations;
    if (families_.size() == 1)
      return go_on(0, evaluations, all_seconds, options_.more_evaluations, has_own ? Costs::both : Costs::same, before > 0);
    // Search by the cost of bounce first, in all waveform families: the best waveform is then a candidate for any target.
    const long own = has_own ? evaluations / target_share : 0;
    const double bounce_seconds = all_seconds * (has_own ? 1 - 1.0 / target_share : 1);
    if (!run_families(evaluations - own, bounce_seconds, has_own ? Costs::guide : Costs::same)) return false;
    // Then search by the target's own cost, if it differs from that of bounce, from the best points of every waveform family.
    // `rest` is the whole remaining budget.
    const long rest = evaluations - (all_.evaluations - before);
    return !has_own || rest <= 0 || run_families(rest, budget_.seconds_left(), Costs::target);
  }

  // Computes the target cost of an evaluation by a closing with the scene's number of modes alone.
  [[nodiscard]] double own_cost(std::size_t family, const Evaluation& e) const {
    SearchSetting alone = settings_[family];
    alone.richer.clear();
    return alone.price(alone.given.applied(alone.drives(families_[family].waveforms(e)))).target;
  }

  [[nodiscard]] FoundWaveform found(const Evaluation& e) const {
    const std::size_t k = e.problem;
    return {.scene = families_[k].prepared(e),
            .cost = settings_[k].richer.empty() ? e.value : own_cost(k, e),
            .family = names_[k],
            .variables = settings_[k].space.variables(),
            .parameters = families_[k].named(e)};
  }

  // Runs a tournament of the waveform families. In the first round every family has an equal share of the budget, and in the
  // second round the best family has the rest. By the cost of bounce, each family of the first round begins at the best points
  // of the families before it. By a target's own cost, the families of the first round are independent, since otherwise all
  // would end in one minimum, and the best family begins at the others' best points in the second round. Returns false if the
  // search was interrupted or failed, or its time is over.
  bool run_families(long all_evaluations, double all_seconds, Costs costs) {
    const SearchBudget all(budget_, all_evaluations, all_seconds);
    const std::size_t count = families_.size();
    const auto equal = static_cast<long>(opening / static_cast<double>(count) * static_cast<double>(all_evaluations));
    constexpr std::array both{Round{}, Round{.contenders = 1}};
    const std::span<const Round> rounds = std::span(both).subspan(equal > 0 ? 0 : 1);
    bool may_go_on = true;
    const Tournament<std::size_t> tournament{
        .budget = budget_,
        .share = [&](const Round& round, std::size_t) -> RoundShare {
          if (round.contenders == 1) return {all_evaluations - static_cast<long>(count) * equal, all.seconds_left()};
          return {equal, opening * all_seconds};
        },
        .search =
            [&](std::size_t& family, SearchInRound turn, const Chain& chain, const SearchBudget& part) {
              if (!may_go_on) return;
              const bool is_last = rounds[turn.round].contenders == 1;
              if ((costs == Costs::target) == is_last) begin_where_others_were(family, costs);
              const double seconds = part.seconds_left() / static_cast<double>(is_last ? 1 : count - turn.number);
              may_go_on = go_on(family, chain.closings, seconds, is_last ? options_.more_evaluations : 0, costs, is_last);
            },
        .select = [&](const std::vector<std::size_t>&,
                      std::size_t) { return may_go_on ? std::vector{leader(costs)} : std::vector<std::size_t>{}; }};
    std::vector<std::size_t> contenders(count);
    std::iota(contenders.begin(), contenders.end(), 0);
    tournament.run(rounds, rounds.size() == both.size() ? contenders : std::vector{leader(costs)});
    return may_go_on && !budget_.over();
  }

  // Adds waveforms of the user as a candidate, and as a start of every waveform family. `prepared()` returns the scene with
  // these waveforms.
  template <class MakePrepared>
  void refine(const std::vector<Signal>& drives, const DriveWaveforms& waveforms, const MakePrepared& prepared) {
    const double cost = settings_.front().price(drives).target;
    for (FamilySearch& family : families_) family.begin_at(waveforms);
    if (!(cost < never_touched)) return;
    Evaluation given{.index = given_index, .value = cost, .x = {}};
    FoundWaveform& landing = landings_.emplace_back(FoundWaveform{
        .scene = prepared(), .cost = cost, .family = names_[0], .variables = settings_[0].space.variables(), .parameters = {}});
    for (std::size_t k = 0; k < families_.size() && given.x.empty(); ++k) {
      const auto x = families_[k].point(waveforms);
      if (!x) continue;
      given.x = *x;
      given.problem = k;
      landing.family = names_[k];
      landing.variables = settings_[k].space.variables();
      landing.parameters = families_[k].named(given);
    }
    log_.begin_with(given, can_be_written(waveforms) ? std::optional(landing.scene.scene.file) : std::nullopt);
  }

  // Returns the number of the waveform family with the least cost; of families with the same cost, the first one.
  [[nodiscard]] std::size_t leader(Costs costs) const {
    std::size_t leader = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < families_.size(); ++k) {
      if (const auto best = families_[k].best(costs); best && best->cost < least) least = best->cost, leader = k;
    }
    return leader;
  }

  void begin_where_others_were(std::size_t family, Costs costs) {
    for (std::size_t k = 0; k < families_.size(); ++k) {
      if (k == family) continue;
      if (const auto best = families_[k].best(costs)) families_[family].begin_at(families_[k].waveforms(best->evaluation));
    }
  }

  // Runs the search of one waveform family for further `evaluations`, and adds its result to all_. Returns false if the search
  // was interrupted or failed, or if no time is left.
  bool go_on(std::size_t family, long evaluations, double time, long more, Costs costs, bool goes_on) {
    if (!(time > 0)) return false;
    const OptimizerResult now =
        families_[family].run({.optimizer = options_.optimizer,
                               .max_evaluations = evaluations,
                               .max_seconds = time,
                               .seed = runs_ == 0 ? options_.seed : random_bits(options_.seed, Stream::library_seed, runs_),
                               .jobs = options_.jobs,
                               .goes_on = goes_on,
                               .stop = options_.stop},
                              costs, more, log_.next_index());
    ++runs_;
    all_.termination = now.termination;
    all_.message = families_.size() > 1 ? fmt::format("{}: {}", names_[family], now.message) : now.message;
    all_.evaluations += now.evaluations;
    if (all_.first_exception.empty()) all_.first_exception = now.first_exception;
    take_improvements();
    return now.termination != Termination::interrupted && now.termination != Termination::failure;
  }

  // Updates, in all_, the best point and the list of evaluations that were the best so far, from the log of all waveform
  // families.
  void take_improvements() {
    all_.improvements = improvements_of(log_.evaluations());
    if (all_.improvements.empty()) return;
    all_.x = all_.improvements.back().x;
    all_.value = all_.improvements.back().value;
    if (all_.termination == Termination::no_feasible_point) all_.termination = Termination::evaluation_budget;
  }

  const std::vector<SearchSetting>& settings_;
  const OptimizeOptions& options_;
  SearchBudget budget_;
  EvaluationLog log_;
  std::vector<std::string> names_;  // names of the waveform families
  std::deque<FamilySearch> families_;
  std::vector<FoundWaveform> landings_;
  OptimizerResult all_;
  std::uint64_t runs_ = 0;
};

// Continues a search whose best waveform is bounce-free only with the scene's number of modes: with slower voltage edges, then
// with the worst cost over several numbers of modes. The database file does not store these evaluations: a resumed search makes
// them again.
class SearchBeyondModes {
 public:
  SearchBeyondModes(const OptimizeOptions& options, SearchBudget& budget, Verification& verified)
      : options_(options), budget_(budget), verified_(verified) {
    own_.starts.clear();
    own_.memory = nullptr;
    own_.more_evaluations = 0;
    own_.begins_with_half = false;
    own_.on_improvement = {};
  }

  /// Continues a search with the settings `gentle`, whose voltage edges are slower, and then by the worst cost over several
  /// numbers of modes. Returns the number of evaluations.
  long go_on(const RunningSearch& search, const std::vector<SearchSetting>& settings, const std::vector<SearchSetting>& gentle) {
    if (!verified_.belongs_to_modes()) return 0;
    if (gentle.empty()) return sift(search, settings);
    if (!begin("searching on with gentler edges", options_.max_evaluations / 2, end_of_gentle)) return 0;
    RunningSearch other(gentle, own_, budget_, own_.max_seconds);
    other.begin();
    (void)other.run();
    other.check(verified_);
    return sift(other, gentle);
  }

  /// Continues the search by the worst cost over the scene's number of modes and more modes, in the best waveform families of
  /// `search`. Returns the number of evaluations.
  long sift(const RunningSearch& search, const std::vector<SearchSetting>& settings) {
    if (!verified_.belongs_to_modes() && !verified_.confirmed()) return evaluations_;
    const std::vector<RunningSearch::Promising> all = search.promising(by_the_worst_of_modes(settings.front()));
    for (std::size_t n = 0; n < std::min(families_sifted, all.size()); ++n) {
      const auto& [k, least, points] = all[n];
      if (!begin("searching on by the worst of more modes", options_.max_evaluations / evaluations_of_the_worst, end_of_worst))
        break;
      std::vector<SearchSetting> worst{by_the_worst_of_modes(settings[k])};
      worst.front().family = 0;  // this search has one waveform family, with the number 0
      own_.family = families_of(options_.family)[k];
      RunningSearch other(worst, own_, budget_, own_.max_seconds);
      for (const std::vector<double>& point : points) other.begin_at_point(point);
      (void)other.run();
      other.check(verified_);
    }
    return evaluations_;
  }

 private:
  // Sets the options of a further search that ends at the share `end` of the time budget. Returns false if no time is left.
  bool begin(std::string what, long evaluations, double end) {
    own_.max_evaluations = std::max(evaluations, 1L);
    own_.max_seconds = budget_.seconds_left(end);
    own_.on_evaluation = [this, what = std::move(what), begun = evaluations_](const Evaluation&, const OptimizeProgress&) {
      ++evaluations_;
      if (!options_.on_preparation) return;
      const double searched = static_cast<double>(evaluations_ - begun) / static_cast<double>(own_.max_evaluations);
      options_.on_preparation(what, std::max(searched, budget_.elapsed() / (end_of_worst * budget_.seconds())));
    };
    return own_.max_seconds > 0 && !budget_.interrupted();
  }

  const OptimizeOptions& options_;
  SearchBudget& budget_;
  OptimizeOptions own_ = options_;
  Verification& verified_;
  long evaluations_ = 0;
};

}  // namespace

long default_budget(const Aim& target, Shaped drives) {
  const long by_bounce = drives == Shaped::electrode ? 5000 : drives == Shaped::several ? 12000 : 20000;
  return target.has_own_cost() ? by_bounce + by_bounce / 2 : by_bounce;
}

OptimizeOptions usual_options(const SceneFile& scene, const Aim& target, Actuator actuator) {
  const Shaped drives = shaped_drives(scene, actuator);
  OptimizeOptions options{.target = target, .actuator = actuator, .family = std::string(default_families(drives))};
  options.max_evaluations = default_budget(target, drives);
  options.more_evaluations = options.max_evaluations / 2;
  options.counts_work = true;
  return options;
}

double OptimizeResult::parameter(std::string_view name) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!name.starts_with(prefix)) return none;
  const auto found = parameters.find(std::string(name.substr(prefix.size())));
  return found == parameters.end() ? none : found->second;
}

OptimizeResult optimize(const SceneFile& file, const OptimizeOptions& asked) {
  OptimizeOptions options = asked;
  static_cast<void>(optimizer_description(options.optimizer));  // throws InvalidInput for an unknown name of an optimizer
  SearchBudget budget({.seconds = options.max_seconds, .stop = options.stop});
  const std::vector<SearchSetting> settings =
      search_settings(file, options.target, options.actuator, options.family,
                      {.stop = options.stop, .report = options.on_preparation}, options.conditions, options.own_waveforms);
  const SearchSetting& setting = settings.front();
  setting.check_starts(options.starts);
  fit_nominal_budget(setting, options);
  const std::vector<SearchSetting> gentle = with_gentle_edges(settings, options.actuator, options.family, options.own_waveforms);
  const bool is_gentle = begins_gently(gentle, options.starts);
  const bool may_go_on = !with_more_modes(setting.given.scene.device).empty();
  const std::vector<SearchSetting>& searched = is_gentle ? gentle : settings;
  budget.leave_out([&] {
    if (options.on_start) options.on_start(searched_columns(searched, options.family));
  });
  options.memory = asked.memory;  // the caller may create the memory of evaluations in on_start
  RunningSearch search(searched, options, budget,
                       std::max(budget.seconds_left(may_go_on ? end_of_search : end_of_worst), budget.seconds() / 4));
  search.begin();
  OptimizeResult result{.scene = setting.given, .baseline_scene = setting.baseline_scene, .baseline = setting.baseline};
  result.baseline_cost = setting.baseline_cost;
  result.search = search.run();
  Verification verified(setting, options);
  search.check(verified);
  result.families = search.families();
  if (options.keep_tried) result.tried = search.tried();
  result.family = result.families.front().family;  // overwritten by move_to() if there is a best waveform
  result.variables = setting.space.variables();
  SearchBeyondModes beyond(options, budget, verified);
  result.evaluations_of_modes = is_gentle ? beyond.sift(search, gentle) : beyond.go_on(search, settings, gentle);
  if (budget.interrupted()) result.search.termination = Termination::interrupted;
  verified.move_to(result);
  result.prefix = prefix_of(options.family, result.family);
  return result;
}

}  // namespace softland
