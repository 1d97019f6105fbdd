#include "studies/search/robust_optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/executor.h"
#include "base/random.h"
#include "base/require.h"
#include "studies/closing/plain_step.h"
#include "studies/search/evaluation_log.h"
#include "studies/search/search_budget.h"
#include "studies/search/tournament.h"

namespace softland {
namespace {

constexpr int nominal_searches = 2;
constexpr std::size_t winners_taken = 4;  // best points taken from each nominal search
constexpr double nominal_time = 0.05;     // share of a time budget for each nominal search
constexpr std::uint64_t selection_devices = 512;
constexpr double apart = 0.08;  // least distance of two starting points, as a share of the variables' ranges

// The effort of finding starting points, which depends on the budget.
struct StartRound {
  long nominal_evaluations;  // number of evaluations of each search on the nominal device
  std::uint64_t box_points;
  std::size_t contenders;  // number of starting points that are tried on more than the first `stages[0]` devices
};
StartRound start_round(long budget) {
  return {.nominal_evaluations = std::clamp(budget / 50, 1L, 1000L),
          .box_points = static_cast<std::uint64_t>(std::clamp(budget / 400, 0L, 64L)),
          .contenders = static_cast<std::size_t>(std::clamp(budget / 2000, 1L, 24L))};
}

// Rounds (stages) of the search. The closings are shares of the budget that is left when the starting points are found.
constexpr std::array robust_rounds{Round{.contenders = 6, .devices = 32, .closings = 0.4, .step = 0.15},
                                   Round{.contenders = 2, .closings = 0.35, .step = 0.06},
                                   Round{.contenders = 1, .closings = 0.25, .step = 0.025}};

using Point = std::vector<double>;

struct Candidate {
  Point x;
  double value = std::numeric_limits<double>::infinity();
};

bool is_better(const Candidate& a, const Candidate& b) { return a.value < b.value; }

double distance(const Point& a, const Point& b, const std::vector<Variable>& variables) {
  double farthest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    farthest = std::max(farthest, std::abs(a[i] - b[i]) / std::max(1e-300, variables[i].upper - variables[i].lower));
  return farthest;
}

// Returns the `count` best candidate waveforms that differ from each other by a least distance, which is halved until there are
// enough candidates.
std::vector<Candidate> best_apart(std::vector<Candidate> all, std::size_t count, const std::vector<Variable>& variables) {
  std::stable_sort(all.begin(), all.end(), is_better);
  std::vector<Candidate> chosen;
  for (double least = apart; chosen.size() < std::min(count, all.size()) && least > apart / 100; least /= 2) {
    for (const Candidate& one : all) {
      if (chosen.size() == count) break;
      const bool far = std::all_of(chosen.begin(), chosen.end(),
                                   [&](const Candidate& other) { return distance(one.x, other.x, variables) > least; });
      if (far) chosen.push_back(one);
    }
  }
  return chosen;
}

std::uint64_t fresh_seed(std::uint64_t seed, std::uint64_t which) { return random_bits(seed, Stream::fresh, which); }

class HalvingSearch {
 public:
  /// `step_cost` is the cost of the plain step, for progress reports.
  HalvingSearch(const SearchSetting& setting, const RobustCost& cost, const RobustAim& aim, const OptimizeOptions& options,
                std::function<double()> clock, double step_cost)
      : setting_(setting),
        cost_(cost),
        options_(options),
        staged_(setting, cost, aim, options.memory, options.seed),
        starts_(start_round(options.max_evaluations)),
        variables_(setting.space.variables()),
        budget_({.evaluations = options.max_evaluations,
                 .seconds = options.max_seconds,
                 .stop = options.stop,
                 .clock = std::move(clock)}),
        log_(options, budget_, step_cost, [&setting](const Evaluation& e) { return setting.scene_at(e.x); }) {}

  // Runs the search. Returns the best points of all rounds (stages), the best first; empty if no point was feasible.
  std::vector<Candidate> run() {
    leaders_ = found_ = first_leaders();
    left_ = static_cast<double>(budget_.left());
    for (const Round& round : robust_rounds) shares_left_ += round.closings;
    const Tournament<Candidate> tournament{
        .budget = budget_,
        .jobs = options_.jobs,
        .share = [this](const Round& round, std::size_t contenders) { return share(round, contenders); },
        .search = [this](Candidate& c, SearchInRound turn, const Chain& chain,
                         SearchBudget& part) { search(c, turn, chain, part); },
        .select = [this](const std::vector<Candidate>& ends, std::size_t k) { return select(ends, k); }};
    tournament.run(robust_rounds, leaders_);
    std::erase_if(found_, [](const Candidate& c) { return !std::isfinite(c.value); });
    std::stable_sort(found_.begin(), found_.end(), is_better);
    return found_;
  }

  [[nodiscard]] long closings() const { return budget_.taken(); }
  /// Returns the number of candidate waveforms in the log: those that were to be tried on all devices, even if some were given
  /// up on the first devices.
  [[nodiscard]] long evaluations() const { return static_cast<long>(log_.evaluations().size()); }
  [[nodiscard]] std::vector<Evaluation> improvements() const { return improvements_of(log_.evaluations()); }
  [[nodiscard]] Termination termination() const {
    if (budget_.interrupted()) return Termination::interrupted;
    if (budget_.out_of_time()) return Termination::time_budget;
    return evaluations() == 0 ? Termination::no_feasible_point : Termination::evaluation_budget;
  }

 private:
  // Adds a candidate waveform to the log if all devices were to be simulated for its cost; otherwise only reports progress.
  void note(bool on_all, long index, const Point& x, double value) {
    if (on_all) return log_.note({.index = index, .value = value, .x = x});
    log_.tell();
  }

  // Searches on the nominal device alone, and returns the best points: they close the nominal device softly.
  std::vector<Point> nominal_winners() {
    std::vector<Point> all;
    for (int k = 0; k < nominal_searches && !budget_.over(); ++k) {
      const OptimizerResult found =
          minimize({.variables = variables_,
                    .objective = [&](std::span<const double> x) { return setting_.cost_at(x, options_.memory).guide; },
                    .starts = setting_.space.starts()},
                   {.max_evaluations = starts_.nominal_evaluations,
                    .max_seconds = std::max(1e-3, nominal_time * options_.max_seconds),
                    .seed = fresh_seed(options_.seed, 10 + static_cast<std::uint64_t>(k)),
                    .jobs = options_.jobs,
                    .stop = options_.stop});
      budget_.took(found.evaluations);
      const std::vector<Evaluation>& best = found.improvements;
      for (std::size_t i = 0; i < std::min(winners_taken, best.size()); ++i) all.push_back(best[best.size() - 1 - i].x);
    }
    return all;
  }

  // Finds starting points for the first round of the search: the best of many, tried on more and more devices.
  std::vector<Candidate> first_leaders() {
    std::vector<DriveWaveforms> given;
    for (const StartingWaveforms& start : options_.starts) given.push_back(start.waveforms);
    std::vector<Candidate> all;
    const auto add = [&](const std::vector<Point>& points) {
      for (const Point& x : points) all.push_back({.x = x});
    };
    add(starting_points(setting_, given));
    add(nominal_winners());
    add(points_of_box(variables_, options_.seed, starts_.box_points));
    for (const std::size_t devices :
         {std::min(stages[0], cost_.devices()), std::min(stages[1], cost_.devices()), cost_.devices()}) {
      const std::size_t begun = run_tasks(
          all.size(), options_.jobs,
          [&](std::size_t i) {
            const StagedCost::Tried tried = staged_.tried(all[i].x, devices);
            all[i].value = tried.cost;
            budget_.took(tried.closings);
            note(devices == cost_.devices(), static_cast<long>(i), all[i].x, all[i].value);
          },
          options_.stop);
      all.resize(begun);
      std::erase_if(all, [](const Candidate& c) { return !std::isfinite(c.value); });
      const std::size_t kept = std::min(starts_.contenders, devices == stages[0] ? all.size() : 2 * robust_rounds[0].contenders);
      all = best_apart(std::move(all), kept, variables_);
    }
    next_index_ = static_cast<long>(all.size());
    return best_apart(std::move(all), robust_rounds[0].contenders, variables_);
  }

  // Returns the closings and the time of one search in a round (stage). Also reserves log indices for each of the searches.
  RoundShare share(const Round& round, std::size_t contenders) {
    const auto count = static_cast<long>(contenders);
    const RoundShare each{.closings = static_cast<long>(round.closings * left_) / count,
                          .seconds = budget_.seconds_left() * round.closings / shares_left_};
    shares_left_ -= round.closings;
    first_index_ = next_index_ + 1000;
    indices_of_search_ = each.closings + 3;
    next_index_ = first_index_ + count * indices_of_search_;
    return each;
  }

  // Searches from a candidate and replaces the candidate by the result. If the search used all devices, only a better result
  // replaces the candidate; otherwise every result does, and is then tried on all devices.
  void search(Candidate& candidate, SearchInRound turn, Chain chain, SearchBudget& part) {
    long index = first_index_ + static_cast<long>(turn.number) * indices_of_search_;
    const bool on_all = chain.devices >= cost_.devices();
    chain.start = candidate.x;
    chain.seed = fresh_seed(options_.seed, 100 + 10 * turn.round + turn.number);
    ChainEnd end = search_chain(staged_, chain, part,
                                [&](const Point& x, double value) { note(on_all, on_all ? index++ : index, x, value); });
    if (on_all) {
      if (end.cost < candidate.value) candidate = {.x = std::move(end.x), .value = end.cost};
      return;
    }
    if (!end.x.empty()) candidate.x = std::move(end.x);
    const StagedCost::Tried tried =
        staged_.tried(candidate.x, cost_.devices(), std::numeric_limits<double>::infinity(), chain.jobs);
    candidate.value = tried.cost;
    part.took(tried.closings);
    note(true, index, candidate.x, candidate.value);
  }

  // Returns the best candidate waveforms of all rounds (stages of the search) so far; the next round begins at these.
  std::vector<Candidate> select(const std::vector<Candidate>& ends, std::size_t round) {
    found_.insert(found_.end(), ends.begin(), ends.end());
    leaders_.insert(leaders_.begin(), ends.begin(), ends.end());
    leaders_ =
        best_apart(std::move(leaders_), robust_rounds[std::min(round + 1, robust_rounds.size() - 1)].contenders, variables_);
    return leaders_;
  }

  const SearchSetting& setting_;
  const RobustCost& cost_;
  const OptimizeOptions& options_;
  StagedCost staged_;
  StartRound starts_;
  std::vector<Variable> variables_;
  SearchBudget budget_;
  EvaluationLog log_;
  // Candidate waveforms at which the next round (stage) begins, and the results of all rounds.
  std::vector<Candidate> leaders_, found_;
  // Closings for all rounds together (stages of the search), and the sum of Round::closings over the remaining rounds.
  double left_ = 0, shares_left_ = 0;
  long next_index_ = 0;  // least log index that no round (stage of the search) has used
  long first_index_ = 0, indices_of_search_ = 0;
};

// Returns the candidate waveform with the least cost over the devices of `others`, which the search has not used.
Candidate compared(std::vector<Candidate> candidates, const SearchSetting& setting, const RobustCost& others, int jobs) {
  candidates = best_apart(std::move(candidates), robust_rounds[0].contenders + 1, setting.space.variables());
  Candidate winner = candidates.front();
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : candidates) {
    const std::vector<Waveform> drives = setting.drives(setting.space.waveforms(candidate.x));
    const double value = others.value(others.close(drives, 0, others.devices(), jobs));
    if (value < least) {
      least = value;
      winner = candidate;
    }
  }
  return winner;
}

// Simulates fresh devices (new to the search) under the best waveform and the plain step over the whole simulated time of the
// scene, and adds the results to `result`.
void judge(RobustResult& result, const RobustCost& cost, const OptimizeOptions& options, const RobustOptions& robust,
           const Progress& progress) {
  OptimizeResult& out = result.found;
  const PreparedScene& best = *out.best_scene;
  result.verdict =
      robustness(best, {{.name = "found", .waveforms = best.drives.waveforms(), .calibration = best.scene.calibration}},
                 {.samples = robust.verdict,
                  .seed = options.seed,
                  .jobs = options.jobs,
                  .measures_drive_energy = options.target.measures_drive_energy(),
                  .worth_of_measuring = true},
                 progress);
  result.findings.fresh_devices = static_cast<double>(result.verdict->devices);
  if (result.verdict->interrupted) out.search.termination = Termination::interrupted;
  const std::vector<DeviceOutcome>& outcomes = result.verdict->drives.back().outcomes;
  out.best_cost = cost.value(outcomes);
  out.baseline_cost = cost.value(result.verdict->drives.front().outcomes);
  const auto failing = std::ranges::count_if(outcomes, fails);
  result.findings.failing = static_cast<double>(failing) / static_cast<double>(outcomes.size());
  result.findings.is_told = cost.is_told(outcomes);
  out.better_than_baseline = result.findings.is_told && out.best_cost < out.baseline_cost;
  const Metrics& drawn = out.best->metrics;
  out.goal_met = out.better_than_baseline && drawn.is_bounce_free();
  const std::optional<Condition>& yield = robust.aim.measure.yield;
  if (yield) result.findings.yield = {.text = yield->text, .share = share_that_fulfils(outcomes, *yield), .holds = true};
  for (const Condition& condition : robust.aim.conditions) {
    result.findings.conditions.push_back(fulfilled(outcomes, condition));
    out.goal_met = out.goal_met && result.findings.conditions.back().holds;
  }
}

// Reduces a default budget if the scene's closings are slow, and reports the estimated work.
void fit_robust_budget(const SearchSetting& setting, OptimizeOptions& options, std::uint64_t verdict) {
  if (!options.counts_work && !options.on_estimate) return;
  constexpr double rows = 4;  // work of the final evaluation per device, in closings of the search
  const ClosingWork one = closing_work(setting);
  const long asked = options.max_evaluations;
  const bool in_lanes = why_not_in_lanes(setting.given.model).empty();
  if (options.counts_work)
    options.max_evaluations = within_work(asked, one.counted * (in_lanes ? 1 : usual_lanes),
                                          usual_work(shaped_drives(setting.given.scene.file, options.actuator)));
  if (!options.on_estimate) return;
  const double closings = static_cast<double>(options.max_evaluations) + rows * static_cast<double>(verdict);
  options.on_estimate({.closing = one.seconds,
                       .closings = options.max_evaluations,
                       .has_fewer = options.max_evaluations < asked,
                       .seconds = std::min(closings * device_share * one.seconds, options.max_seconds * options.jobs)});
}

void require_one_family(const OptimizeOptions& options) {
  require_request(families_of(options.family).size() == 1, [&] {
    return fmt::format("{} {}: a search over devices takes one family", requested("waveform"), options.family);
  });
}

}  // namespace

FulfilledCondition fulfilled(const std::vector<DeviceOutcome>& outcomes, const Condition& condition) {
  const Yield share = share_that_fulfils(outcomes, condition);
  return {.text = condition.text, .share = share, .holds = share.value >= constrained_share};
}

RobustResult robust_optimize(const SceneFile& file, const OptimizeOptions& given, const RobustOptions& asked) {
  OptimizeOptions options = given;
  require_one_family(options);
  const Progress progress{.stop = options.stop, .report = options.on_preparation};
  const SearchSetting setting =
      search_setting(file, options.target, options.actuator, options.family, progress, {}, options.own_waveforms);
  setting.check_starts(options.starts);
  fit_robust_budget(setting, options, asked.verdict);
  const MeasuredUnits known =
      measured_units(setting.given, std::array{setting.given.scene.calibration}, options.jobs, progress).front();
  RobustOptions robust = asked;
  for (const Condition& one : robust.aim.conditions) require_asked(one, setting.given.scene.metrics.asked);
  if (robust.aim.measure.yield) require_asked(*robust.aim.measure.yield, setting.given.scene.metrics.asked);
  const RobustCost cost(setting, robust.aim,
                        own_devices(setting, known, robust.samples, options.seed, 0, options.jobs, progress));
  RobustResult result{.found = {.scene = setting.given, .baseline_scene = setting.baseline_scene, .baseline = setting.baseline},
                      .findings = {.measure = robust.aim.measure.text, .devices = static_cast<double>(robust.samples)}};
  OptimizeResult& out = result.found;
  out.family = options.family;
  out.variables = setting.space.variables();
  std::vector<std::string> names;
  for (const Variable& v : out.variables) names.push_back(v.name);
  if (options.on_start) options.on_start({.families = {names}});
  options.memory = given.memory;  // on_start may have created the memory of evaluations
  const std::vector<DeviceOutcome> of_step = cost.close(setting.drives({}), 0, cost.devices(), options.jobs);
  robust.aim.conditions = beside_step(std::move(robust.aim.conditions), of_step);
  out.baseline_cost = cost.value(of_step);

  HalvingSearch search(setting, cost, robust.aim, options, robust.clock, out.baseline_cost);
  std::vector<Candidate> candidates = search.run();
  result.findings.closings = static_cast<double>(search.closings());
  out.search.evaluations = search.evaluations();
  out.search.improvements = search.improvements();
  out.search.termination = search.termination();
  if (candidates.empty()) return result;

  // An interruption from here on returns the results so far, without results on fresh devices (new to the search).
  Candidate winner = candidates.front();
  try {
    if (out.search.termination != Termination::interrupted)
      winner = compared(std::move(candidates), setting,
                        RobustCost(setting, robust.aim,
                                   own_devices(setting, known, selection_devices, options.seed, 1, options.jobs, progress)),
                        options.jobs);
  } catch (const Interrupted&) {
    out.search.termination = Termination::interrupted;
  }
  result.findings.cost_on_searched = out.best_cost = winner.value;
  out.better_than_baseline = out.best_cost < out.baseline_cost;
  out.best_scene = setting.prepared(setting.space.waveforms(winner.x));
  out.best = simulate(*out.best_scene, true, {.report = options.on_preparation});
  for (std::size_t k = 0; k < names.size(); ++k) out.parameters[names[k]] = winner.x[k];
  if (out.search.termination == Termination::interrupted) return result;
  try {
    judge(result, cost, options, robust, progress);
  } catch (const Interrupted&) {
    out.search.termination = Termination::interrupted;
  }
  return result;
}

SearchedParameters searched_parameters(const SceneFile& file, const OptimizeOptions& options, bool over_devices,
                                       const Progress& progress) {
  static_cast<void>(optimizer_description(options.optimizer));
  const std::vector<SearchSetting> settings = search_settings(file, options.target, options.actuator, options.family, progress,
                                                              options.conditions, options.own_waveforms);
  const SearchSetting& setting = settings.front();
  setting.check_starts(options.starts);
  if (over_devices) {
    require_one_family(options);
    static_cast<void>(measured_units(setting.given, std::array{setting.given.scene.calibration}, options.jobs, progress));
    static_cast<void>(Ensemble(setting.given, 1, options.seed));
  }
  return {.columns = searched_columns(settings, options.family),
          .significant_rebound = setting.given.scene.metrics.significant_rebound};
}

}  // namespace softland
