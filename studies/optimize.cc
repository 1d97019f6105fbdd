#include "studies/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/engineering.h"
#include "studies/plain_step.h"
#include "studies/search_setting.h"

namespace softland {
namespace {

constexpr double tight_tolerance = 1e-9;    // of the confirming run
constexpr int more_modes = 2;               // of the confirming run
constexpr std::size_t most_candidates = 8;  // of the search, verified at the most
constexpr double distinct = 1.01;           // ratio of the costs of two candidates

// The target's own figure, infinite where the closing has none.
double figure(Target target, const Metrics& m) {
  const double value = figure_of(target).value(m);
  return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

// The same closing by a tighter integrator, and with a richer beam where there is one.
std::vector<ConfirmingRun> confirm(const Prepared& winner) {
  const std::vector<Signal> signals = winner.signals();
  const auto run = [&](const Switch& model, double tolerance) {
    return metrics(simulate_closing(model, signals, {.duration = winner.duration, .tolerance = tolerance}), winner.scene.metrics);
  };
  std::vector<ConfirmingRun> runs{{"tolerance " + engineering(tight_tolerance, ""), run(winner.model, tight_tolerance)}};
  Device richer = winner.scene.device;
  if (richer.structure.kind != StructureKind::plate) {
    richer.structure.modes = std::min(20, richer.structure.modes + more_modes);
    runs.push_back({fmt::format("{} modes", richer.structure.modes), run(Switch(richer, winner.quadrature), winner.tolerance)});
  }
  return runs;
}

// How far a candidate is believed.
enum class Belief { touches, settles, meets_goal, confirmed };

// A candidate after its run over the whole window, as its file says, at the accuracy the scene asks for.
struct Verified {
  Prepared scene;
  Closing closing;
  std::vector<ConfirmingRun> checks;
  std::map<std::string, double> parameters;
  double cost = 0;
  double figure = 0;  // the target's own; rebounds that are not significant are equal
  Belief belief = Belief::touches;

  [[nodiscard]] bool better_than(const Verified& other) const {
    return std::tuple(-static_cast<int>(belief), figure, cost) <
           std::tuple(-static_cast<int>(other.belief), other.figure, other.cost);
  }
};

// The best of a search's improvements first, each distinctly worse than the one before: neighbours would fail for the same
// reason.
std::vector<Evaluation> candidates(const std::vector<Evaluation>& improvements) {
  std::vector<Evaluation> chosen;
  for (auto e = improvements.rbegin(); e != improvements.rend() && chosen.size() < most_candidates; ++e) {
    if (!(e->value < never_touched)) break;
    if (chosen.empty() || e->value > distinct * chosen.back().value) chosen.push_back(*e);
  }
  return chosen;
}

}  // namespace

long default_budget(Target target, Actuator actuator) {
  const long by_bounce = actuator == Actuator::electrostatic ? 2500 : 10000;
  return has_own_cost(target) ? by_bounce + by_bounce / 2 : by_bounce;
}

bool goal_met(Target target, const Metrics& best, const Metrics& baseline) {
  if (!best.settled || best.bounce_count > 0) return false;
  return !has_own_cost(target) || figure(target, best) < figure(target, baseline);
}

OptimizeResult optimize(const SceneFile& file, const OptimizeOptions& options) {
  static_cast<void>(optimizer_description(options.optimizer));  // throws for an unknown name
  const Watch before{.stop = options.stop, .progress = options.on_preparation}, after{.progress = options.on_preparation};
  const SearchSetting setting = search_setting(file, options.target, options.actuator, options.family, before);
  const Prepared& given = setting.given;
  OptimizeResult result{.scene = given, .baseline_scene = setting.baseline_scene, .baseline = setting.baseline};
  result.baseline_cost = setting.baseline_cost;
  result.variables = setting.space.variables();

  Problem problem{.variables = result.variables, .objective = {}, .starts = setting.space.starts()};
  std::vector<std::string> variable_names;
  for (const Variable& v : problem.variables) variable_names.push_back(v.name);
  const auto named = [&](std::span<const double> x) {
    std::map<std::string, double> parameters;
    for (std::size_t k = 0; k < x.size(); ++k) parameters[variable_names[k]] = x[k];
    return parameters;
  };
  if (options.on_start) options.on_start(variable_names);
  OptimizeProgress progress{.baseline_cost = result.baseline_cost};

  // A scene that holds a landing already is refined: its drives are the first candidate, and where the search can describe them
  // it starts there.
  double given_cost = never_touched;
  const std::optional<std::vector<double>> given_point = setting.space.parameters(given.drives.waveforms);
  if (!same_drives(given.signals(), setting.baseline_scene.signals())) {
    given_cost = setting.price(given.signals()).own;
    if (given_point) problem.starts.insert(problem.starts.begin(), *given_point);
    if (given_cost < never_touched) {
      progress.best_cost = given_cost;
      if (options.on_improvement)
        options.on_improvement({.index = given_index, .value = given_cost, .x = given_point.value_or(std::vector<double>{})},
                               with_waveforms(given, {}));
    }
  }

  TwoStages stages([&](std::span<const double> x) { return setting.price_at(x); },
                   [&](const Evaluation& e) {
                     ++progress.evaluations;
                     const bool improves = std::isfinite(e.value) && !(progress.best_cost <= e.value);
                     if (improves) progress.best_cost = e.value;
                     if (options.on_evaluation) options.on_evaluation(e, progress);
                     if (improves && options.on_improvement && e.value < never_touched)
                       options.on_improvement(e, setting.scene(setting.space.waveforms(e.x)));
                   });
  result.search = stages.run(std::move(problem),
                             {.optimizer = options.optimizer,
                              .max_evaluations = options.max_evaluations,
                              .max_seconds = options.max_seconds,
                              .seed = options.seed,
                              .jobs = options.jobs,
                              .stop = options.stop},
                             has_own_cost(options.target));

  // Believe no candidate before it has been verified, nor prefer one whose landing a tighter integrator or a richer beam undoes.
  std::optional<Verified> winner;
  const auto verify = [&](const SceneFile& text, double value, std::map<std::string, double> parameters) {
    Prepared scene = read_back(text, "best.toml", given);
    Closing closing = simulate(scene, true, after);
    const auto met = [&](const Metrics& m) { return goal_met(options.target, m, result.baseline.metrics); };
    const Metrics& m = closing.metrics;
    Verified now{.scene = std::move(scene),
                 .closing = closing,
                 .checks = {},
                 .parameters = std::move(parameters),
                 .cost = value,
                 .figure = figure(options.target, m),
                 .belief = met(m)      ? Belief::meets_goal
                           : m.settled ? Belief::settles
                                       : Belief::touches};
    if (options.target == Target::bounce || options.target == Target::rebound)
      now.figure = std::max(now.figure, given.scene.metrics.significant_rebound);
    if (now.belief == Belief::meets_goal || !winner || now.better_than(*winner)) now.checks = confirm(now.scene);
    if (now.belief == Belief::meets_goal &&
        std::all_of(now.checks.begin(), now.checks.end(), [&](const ConfirmingRun& c) { return met(c.metrics); }))
      now.belief = Belief::confirmed;
    if (!winner || now.better_than(*winner)) winner = std::move(now);
  };
  if (given_cost < never_touched)
    verify(with_waveforms(given, {}), given_cost, given_point ? named(*given_point) : std::map<std::string, double>{});
  for (const Evaluation& e : candidates(result.search.improvements)) {
    verify(setting.scene(setting.space.waveforms(e.x)), e.value, named(e.x));
    if (winner->belief == Belief::confirmed && winner->cost <= e.value) break;
  }
  if (winner) {
    const Metrics& m = winner->closing.metrics;
    result.goal_met = winner->belief >= Belief::meets_goal;
    result.better_than_baseline = figure(options.target, m) < figure(options.target, result.baseline.metrics);
    result.best_scene = std::move(winner->scene);
    result.best = std::move(winner->closing);
    result.checks = std::move(winner->checks);
    result.parameters = std::move(winner->parameters);
    result.best_cost = winner->cost;
  }
  return result;
}

}  // namespace softland
