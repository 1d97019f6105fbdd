#include "studies/search/robust_optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include "base/executor.h"
#include "base/random.h"
#include "base/require.h"
#include "optimizers/sobol.h"
#include "studies/closing/plain_step.h"
#include "studies/search/device_chain.h"
#include "studies/search/search_work.h"

namespace softland {
namespace {

constexpr int nominal_searches = 2;
constexpr std::size_t winners_taken = 4;  // winners of each of these searches
constexpr double scouting_time = 0.05;    // share of a budget of time, for each search on the nominal device
constexpr std::uint64_t selection_devices = 512;
constexpr double apart = 0.08;  // least distance of starts, as a part of the box

constexpr std::size_t all_devices = std::numeric_limits<std::size_t>::max();

// Effort for finding starts, by the budget.
struct Scouting {
  long nominal_evaluations;  // evaluations of each search on the nominal device
  std::uint64_t box_points;
  std::size_t raced;  // starts that are tried on more than the first devices
};
Scouting scouting(long budget) {
  return {.nominal_evaluations = std::clamp(budget / 50, 1L, 1000L),
          .box_points = static_cast<std::uint64_t>(std::clamp(budget / 400, 0L, 64L)),
          .raced = static_cast<std::size_t>(std::clamp(budget / 2000, 1L, 24L))};
}

struct Heat {
  std::size_t searches;
  std::size_t devices;  // most devices of a search
  double share;         // share of the budget
  double step;          // first step, as a part of the box
};
constexpr std::array heats{Heat{6, 32, 0.4, 0.15}, Heat{2, all_devices, 0.35, 0.06}, Heat{1, all_devices, 0.25, 0.025}};

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

// Returns the best that are apart from each other; the distance shrinks until there are enough.
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

class RobustSearch {
 public:
  /// `step_cost` is that of the plain step, for the progress.
  RobustSearch(const SearchSetting& setting, const RobustCost& cost, const RobustAim& aim, const OptimizeOptions& options,
               const std::function<double()>& clock, double step_cost)
      : setting_(setting),
        cost_(cost),
        options_(options),
        staged_(setting, cost, aim, options.memory, options.seed),
        scouting_(scouting(options.max_evaluations)),
        variables_(setting.space.variables()),
        clock_(clock),
        begin_(clock()) {
    progress_.baseline_cost = step_cost;
  }

  // Returns the best points of all rounds, the best first; empty if nothing was feasible.
  std::vector<Candidate> run() {
    std::vector<Candidate> leaders = first_leaders();
    std::vector<Candidate> found = leaders;
    const auto left = static_cast<double>(options_.max_evaluations - closings_);
    double shares_left = 0;
    for (const Heat& heat : heats) shares_left += heat.share;
    for (const Heat& heat : heats) {
      if (over() || leaders.empty()) break;
      leaders.resize(std::min(leaders.size(), heat.searches));
      if (static_cast<long>(heat.share * left) < static_cast<long>(leaders.size())) break;
      heat_end_ = elapsed() + (options_.max_seconds - elapsed()) * heat.share / shares_left;
      shares_left -= heat.share;
      const std::vector<Candidate> ends = search_from(leaders, heat, static_cast<long>(heat.share * left));
      found.insert(found.end(), ends.begin(), ends.end());
      // The best go on, from whichever round.
      std::vector<Candidate> all = ends;
      all.insert(all.end(), leaders.begin(), leaders.end());
      std::stable_sort(all.begin(), all.end(), is_better);
      leaders = best_apart(all, heat.searches, variables_);
    }
    std::erase_if(found, [](const Candidate& c) { return !std::isfinite(c.value); });
    std::stable_sort(found.begin(), found.end(), is_better);
    return found;
  }

  [[nodiscard]] long closings() const { return closings_; }
  /// Number of evaluations on all devices, or on as many of them as it took to give a candidate up.
  [[nodiscard]] long evaluations() const { return static_cast<long>(log_.size()); }
  [[nodiscard]] std::vector<Evaluation> improvements() const {
    std::vector<Evaluation> all;
    for (const auto& [index, e] : log_) {
      if (all.empty() || e.value < all.back().value) all.push_back(e);
    }
    return all;
  }
  [[nodiscard]] Termination termination() const {
    if (interrupted()) return Termination::interrupted;
    if (out_of_time()) return Termination::time_budget;
    return log_.empty() ? Termination::no_feasible_point : Termination::evaluation_budget;
  }

 private:
  [[nodiscard]] bool interrupted() const { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); }
  [[nodiscard]] double elapsed() const { return clock_() - begin_; }
  [[nodiscard]] bool out_of_time() const { return elapsed() > options_.max_seconds; }
  [[nodiscard]] bool over() const { return interrupted() || out_of_time(); }

  // Notes an evaluation on all devices; `index` orders them whatever the threads.
  void note(long index, const Point& x, double value) {
    const std::scoped_lock lock(mutex_);
    const Evaluation e{.index = index, .value = value, .x = x};
    log_.emplace(index, e);
    const bool improves = std::isfinite(value) && !(progress_.best_cost <= value);
    if (improves) progress_.best_cost = value;
    progress_.evaluations = closings_;
    if (options_.on_evaluation) options_.on_evaluation(e, progress_);
    if (!improves || !options_.on_improvement) return;
    if (const auto waveforms = setting_.space.waveforms(x); can_be_written(waveforms))
      options_.on_improvement(e, setting_.scene(waveforms));
  }

  void tell() {
    if (!options_.on_progress) return;
    const std::scoped_lock lock(mutex_);
    progress_.evaluations = closings_;
    options_.on_progress(progress_);
  }

  // Finds waveforms that land the nominal device.
  std::vector<Point> nominal_winners() {
    std::vector<Point> all;
    for (int k = 0; k < nominal_searches && !over(); ++k) {
      const OptimizerResult found =
          minimize({.variables = variables_,
                    .objective = [&](std::span<const double> x) { return setting_.price_at(x, options_.memory).leading; },
                    .starts = setting_.space.starts()},
                   {.max_evaluations = scouting_.nominal_evaluations,
                    .max_seconds = std::max(1e-3, scouting_time * options_.max_seconds),
                    .seed = fresh_seed(options_.seed, 10 + static_cast<std::uint64_t>(k)),
                    .jobs = options_.jobs,
                    .stop = options_.stop});
      closings_ += found.evaluations;
      const std::vector<Evaluation>& best = found.improvements;
      for (std::size_t i = 0; i < std::min(winners_taken, best.size()); ++i) all.push_back(best[best.size() - 1 - i].x);
    }
    return all;
  }

  // Finds starts for the first round: the best of many on ever more devices.
  std::vector<Candidate> first_leaders() {
    std::vector<Candidate> all;
    const auto add = [&](const Point& x) { all.push_back({.x = x}); };
    for (const Point& x : setting_.space.starts()) add(x);
    if (const auto given = setting_.space.parameters(setting_.given.drives.waveforms())) add(*given);
    for (const StartingWaveforms& start : options_.starts) add(setting_.space.nearest(start.waveforms));
    for (const Point& x : nominal_winners()) add(x);
    for (Point u : internal::sobol_points(options_.seed, variables_.size(), 0, scouting_.box_points)) {
      for (std::size_t i = 0; i < u.size(); ++i) u[i] = variables_[i].lower + u[i] * (variables_[i].upper - variables_[i].lower);
      add(u);
    }
    for (const std::size_t devices :
         {std::min(stages[0], cost_.devices()), std::min(stages[1], cost_.devices()), cost_.devices()}) {
      const std::size_t begun = run_tasks(
          all.size(), options_.jobs,
          [&](std::size_t i) {
            const StagedCost::Tried tried = staged_.tried(all[i].x, devices);
            all[i].value = tried.cost;
            closings_ += tried.closings;
            devices == cost_.devices() ? note(static_cast<long>(i), all[i].x, all[i].value) : tell();
          },
          options_.stop);
      all.resize(begun);
      std::erase_if(all, [](const Candidate& c) { return !std::isfinite(c.value); });
      const std::size_t kept = std::min(scouting_.raced, devices == stages[0] ? all.size() : 2 * heats[0].searches);
      all = best_apart(std::move(all), kept, variables_);
    }
    next_index_ = static_cast<long>(all.size());
    return best_apart(std::move(all), heats[0].searches, variables_);
  }

  // Runs one search from each of the starts, with its share of the closings.
  std::vector<Candidate> search_from(const std::vector<Candidate>& starts, const Heat& heat, long closings) {
    const long share = closings / static_cast<long>(starts.size()), block = share + 3;
    const int inner = std::max(1, options_.jobs / static_cast<int>(starts.size()));
    const long first_index = next_index_ + 1000;
    std::vector<Candidate> ends = starts;
    run_tasks(
        starts.size(), options_.jobs,
        [&](std::size_t i) {
          ends[i] =
              search_one(starts[i], heat, share, inner, first_index + static_cast<long>(i) * block, 100 + 10 * heats_run_ + i);
        },
        options_.stop);
    next_index_ = first_index + static_cast<long>(starts.size()) * block;
    ++heats_run_;
    return ends;
  }

  Candidate search_one(const Candidate& start, const Heat& heat, long share, int jobs, long index, std::uint64_t number) {
    const std::size_t devices = std::min(heat.devices, cost_.devices());
    const auto told = [&](const Point& x, double value, long closings) {
      closings_ += closings;
      devices == cost_.devices() ? note(index++, x, value) : tell();
      return interrupted() || elapsed() > heat_end_;
    };
    const ChainEnd end = search_chain(staged_, variables_,
                                      {.start = start.x,
                                       .devices = devices,
                                       .closings = share,
                                       .step = heat.step,
                                       .seed = fresh_seed(options_.seed, number),
                                       .jobs = jobs},
                                      told);
    if (devices == cost_.devices()) return end.cost < start.value ? Candidate{.x = end.x, .value = end.cost} : start;
    Candidate best{.x = end.x.empty() ? start.x : end.x};  // the cost on fewer devices differs
    const StagedCost::Tried tried = staged_.tried(best.x, cost_.devices(), std::numeric_limits<double>::infinity(), jobs);
    best.value = tried.cost;
    closings_ += tried.closings;
    note(index++, best.x, best.value);
    return best;
  }

  const SearchSetting& setting_;
  const RobustCost& cost_;
  const OptimizeOptions& options_;
  StagedCost staged_;
  Scouting scouting_;
  std::vector<Variable> variables_;
  std::function<double()> clock_;
  double begin_;  // time of the beginning [s]
  std::atomic<long> closings_ = 0;
  std::uint64_t heats_run_ = 0;
  double heat_end_ = 0;  // end of the round in a budget of time, since the beginning [s]
  long next_index_ = 0;

  std::mutex mutex_;
  std::map<long, Evaluation> log_;
  OptimizeProgress progress_;
};

// Returns the best of the candidates on devices that none of them was made for.
Candidate compared(std::vector<Candidate> candidates, const SearchSetting& setting, const RobustCost& others, int jobs) {
  candidates = best_apart(std::move(candidates), heats[0].searches + 1, setting.space.variables());
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

// Judges the winner and the plain step on fresh devices, over the whole window.
void judge(RobustResult& result, const RobustCost& cost, const OptimizeOptions& options, const RobustOptions& robust,
           const Watch& watch) {
  OptimizeResult& out = result.found;
  const PreparedScene& best = *out.best_scene;
  result.verdict =
      robustness(best, {{.name = "found", .waveforms = best.drives.waveforms(), .calibration = best.scene.calibration}},
                 {.samples = robust.verdict,
                  .seed = options.seed,
                  .jobs = options.jobs,
                  .measures_drive_energy = options.target.measures_drive_energy(),
                  .worth_of_measuring = true},
                 watch);
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
  out.goal_met = out.better_than_baseline && drawn.lands();
  const std::optional<Criterion>& yield = robust.aim.measure.yield;
  if (yield) result.findings.yield = {.text = yield->text, .share = share_that_fulfils(outcomes, *yield), .holds = true};
  for (const Criterion& condition : robust.aim.conditions) {
    result.findings.conditions.push_back(fulfilled(outcomes, condition));
    out.goal_met = out.goal_met && result.findings.conditions.back().holds;
  }
}

// Scales the budget to closings of these devices, and reports the estimate.
void fit_robust_budget(const SearchSetting& setting, OptimizeOptions& options, std::uint64_t verdict) {
  if (!options.counts_work && !options.on_estimate) return;
  constexpr double rows = 4;  // closings per device of the verdict, over the whole window
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

FulfilledCondition fulfilled(const std::vector<DeviceOutcome>& outcomes, const Criterion& condition) {
  const Yield share = share_that_fulfils(outcomes, condition);
  return {.text = condition.text, .share = share, .holds = share.value >= constrained_share};
}

RobustResult robust_optimize(const SceneFile& file, const OptimizeOptions& given, const RobustOptions& asked) {
  OptimizeOptions options = given;
  require_one_family(options);
  const Watch watch{.stop = options.stop, .progress = options.on_preparation};
  const SearchSetting setting =
      search_setting(file, options.target, options.actuator, options.family, watch, {}, options.own_waveforms);
  setting.check_starts(options.starts);
  fit_robust_budget(setting, options, asked.verdict);
  const KnownUnits known = known_units(setting.given, std::array{setting.given.scene.calibration}, options.jobs, watch).front();
  RobustOptions robust = asked;
  for (const Criterion& one : robust.aim.conditions) require_asked(one, setting.given.scene.metrics.asked);
  if (robust.aim.measure.yield) require_asked(*robust.aim.measure.yield, setting.given.scene.metrics.asked);
  const RobustCost cost(setting, robust.aim, own_devices(setting, known, robust.samples, options.seed, 0, options.jobs, watch));
  RobustResult result{.found = {.scene = setting.given, .baseline_scene = setting.baseline_scene, .baseline = setting.baseline},
                      .findings = {.measure = robust.aim.measure.text, .devices = static_cast<double>(robust.samples)}};
  OptimizeResult& out = result.found;
  out.family = options.family;
  out.variables = setting.space.variables();
  std::vector<std::string> names;
  for (const Variable& v : out.variables) names.push_back(v.name);
  if (options.on_start) options.on_start({.families = {names}});
  options.memory = given.memory;  // the memory may exist only from now on
  const std::vector<DeviceOutcome> of_step = cost.close(setting.drives({}), 0, cost.devices(), options.jobs);
  robust.aim.conditions = beside_step(std::move(robust.aim.conditions), of_step);
  out.baseline_cost = cost.value(of_step);

  RobustSearch search(setting, cost, robust.aim, options, robust.clock, out.baseline_cost);
  std::vector<Candidate> candidates = search.run();
  result.findings.closings = static_cast<double>(search.closings());
  out.search.evaluations = search.evaluations();
  out.search.improvements = search.improvements();
  out.search.termination = search.termination();
  if (candidates.empty()) return result;

  // A stop from here on leaves the results so far, without the verdict.
  Candidate winner = candidates.front();
  try {
    if (out.search.termination != Termination::interrupted)
      winner = compared(
          std::move(candidates), setting,
          RobustCost(setting, robust.aim, own_devices(setting, known, selection_devices, options.seed, 1, options.jobs, watch)),
          options.jobs);
  } catch (const Interrupted&) {
    out.search.termination = Termination::interrupted;
  }
  result.findings.cost_on_searched = out.best_cost = winner.value;
  out.better_than_baseline = out.best_cost < out.baseline_cost;
  out.best_scene = setting.prepared(setting.space.waveforms(winner.x));
  out.best = simulate(*out.best_scene, true, {.progress = options.on_preparation});
  for (std::size_t k = 0; k < names.size(); ++k) out.parameters[names[k]] = winner.x[k];
  if (out.search.termination == Termination::interrupted) return result;
  try {
    judge(result, cost, options, robust, watch);
  } catch (const Interrupted&) {
    out.search.termination = Termination::interrupted;
  }
  return result;
}

SearchedParameters searched_parameters(const SceneFile& file, const OptimizeOptions& options, bool over_devices,
                                       const Watch& watch) {
  static_cast<void>(optimizer_description(options.optimizer));
  const std::vector<SearchSetting> settings =
      search_settings(file, options.target, options.actuator, options.family, watch, options.conditions, options.own_waveforms);
  const SearchSetting& setting = settings.front();
  setting.check_starts(options.starts);
  if (over_devices) {
    require_one_family(options);
    static_cast<void>(known_units(setting.given, std::array{setting.given.scene.calibration}, options.jobs, watch));
    static_cast<void>(Ensemble(setting.given, 1, options.seed));
  }
  return {.columns = searched_columns(settings, options.family),
          .significant_rebound = setting.given.scene.metrics.significant_rebound};
}

}  // namespace softland
