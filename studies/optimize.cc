#include "studies/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/engineering.h"
#include "base/require.h"
#include "model/constants.h"
#include "studies/choices.h"
#include "studies/plain_step.h"
#include "studies/two_stages.h"

namespace softland {
namespace {

constexpr double never_touched = 10;  // costs from here on: see cost()
constexpr double latest_touch = 2.5;  // times the baseline's first touch
// Lateness that costs little: an electrode can throw and catch the beam in about the time of the step, a piezo only slows it.
constexpr double driven_touch = 1.5, braked_touch = 2.0;
constexpr double search_tolerance = 1e-6;   // of the integrator: costs good to about 1e-4
constexpr double tight_tolerance = 1e-9;    // of the confirming run
constexpr int more_modes = 2;               // of the confirming run
constexpr std::size_t most_candidates = 8;  // of the search, verified at the most
constexpr double distinct = 1.01;           // ratio of the costs of two candidates

// The scene with other waveforms on some drives.
SceneFile with_waveforms(const Prepared& p, const std::map<std::string, Waveform>& waveforms) {
  SceneFile file = resolved(p.scene, p.voltage_units());
  for (const auto& [drive, waveform] : waveforms) file.set_waveform(drive, waveform);
  return file;
}

// Text of the scene, read back: what a user's `simulate best.toml` will run. Warnings stay those about the file that the user
// wrote.
Prepared read_back(const SceneFile& file, const std::string& name, const Prepared& given) {
  Prepared p = prepare_and_choose(SceneFile::parse(file.text(), name));
  p.scene.warnings = given.scene.warnings;
  return p;
}

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
  Prepared given = prepare_and_choose(file, true, before);
  require(given.model.has_contact(), "optimize needs a [contact] section: without contact there is nothing to land on");

  Prepared baseline_scene = read_back(with_waveforms(given, plain_step(given, options.actuator)), "baseline.toml", given);
  OptimizeResult result{.scene = given, .baseline_scene = baseline_scene, .baseline = simulate(baseline_scene, true, before)};
  before.throw_if_stopped();

  // How candidates are scored.
  const double period = 2 * pi / given.model.angular_frequencies()[0];
  const MetricsOptions& metrics_options = given.scene.metrics;
  CostScale scale{.step = {},
                  .score_window = std::max(period, 3 * given.model.in_contact_period()),
                  .contact_gap = given.scene.device.gap.contact,
                  .free_touch = options.actuator == Actuator::pzt ? braked_touch : driven_touch};
  ClosingOptions run{.duration = given.duration, .tolerance = search_tolerance, .after_contact = scale.score_window};
  std::vector<double> rest;
  for (const Signal& s : baseline_scene.signals()) rest.push_back(s.hold_level());
  if (const auto closed = closed_equilibrium(given.model, rest)) run.closed_potential = closed->potential;
  const Trajectory step = simulate_closing(given.model, baseline_scene.signals(), run);
  scale.step = cost_figures(step, metrics_options);
  if (!scale.step.touched) {
    // A hold level that a plain step does not close with may still close with a throw: scale by what a closing of this beam would
    // be like.
    scale.step = {.touched = true,
                  .first_touch = period / 2,
                  .touch_speed = given.scene.device.gap.contact * given.model.angular_frequencies()[0],
                  .rebound_height = given.scene.device.gap.contact,
                  .impact_energy = 0};
  }
  result.baseline_cost = cost(options.target, step, scale, metrics_options);
  // A landing so late that the window ends before the switch could bounce would look like a soft one.
  run.no_contact_before = std::min(latest_touch * scale.step.first_touch, given.duration - 2 * given.model.in_contact_period());
  require(run.no_contact_before > 0,
          fmt::format("simulate.duration = {} is too short to judge a landing: it needs more than {}",
                      engineering(given.duration, "s", 3), engineering(2 * given.model.in_contact_period(), "s", 3)));
  run.duration = std::max(run.duration, run.no_contact_before + scale.score_window);

  const SearchSpace space(given, options.actuator, options.family, scale.step.first_touch);
  const std::vector<std::string> names = given.drive_names();
  const std::vector<Signal> standing = baseline_scene.signals();
  result.variables = space.variables();
  const auto price = [&](const std::vector<Signal>& signals) {
    CostObserver observer(scale.contact_gap, metrics_options);
    const Trajectory end = observe_closing(given.model, signals, run, observer);
    const CostFigures figures = observer.figures(end.landing_excess);
    const auto by = [&](Target target) { return cost(target, end.status, figures, scale, metrics_options); };
    const double leading = by(Target::bounce);
    return Prices{.leading = leading, .own = has_own_cost(options.target) ? by(options.target) : leading};
  };
  const auto price_at = [&](std::span<const double> x) {
    std::vector<Signal> signals = standing;
    for (const auto& [drive, waveform] : space.waveforms(x)) {
      const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), drive) - names.begin());
      signals[at] = signal(waveform);
      if (!violation(signals[at], given.drives.limits.at(drive)).empty()) return Prices{};
    }
    return price(signals);
  };

  Problem problem{.variables = space.variables(), .objective = {}, .starts = space.starts()};
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
  const std::optional<std::vector<double>> given_point = space.parameters(given.drives.waveforms);
  if (!same_drives(given.signals(), standing)) {
    given_cost = price(given.signals()).own;
    if (given_point) problem.starts.insert(problem.starts.begin(), *given_point);
    if (given_cost < never_touched) {
      progress.best_cost = given_cost;
      if (options.on_improvement)
        options.on_improvement({.index = given_index, .value = given_cost, .x = given_point.value_or(std::vector<double>{})},
                               with_waveforms(given, {}));
    }
  }

  TwoStages stages(price_at, [&](const Evaluation& e) {
    ++progress.evaluations;
    const bool improves = std::isfinite(e.value) && !(progress.best_cost <= e.value);
    if (improves) progress.best_cost = e.value;
    if (options.on_evaluation) options.on_evaluation(e, progress);
    if (improves && options.on_improvement && e.value < never_touched)
      options.on_improvement(e, with_waveforms(baseline_scene, space.waveforms(e.x)));
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
      now.figure = std::max(now.figure, metrics_options.significant_rebound);
    if (now.belief == Belief::meets_goal || !winner || now.better_than(*winner)) now.checks = confirm(now.scene);
    if (now.belief == Belief::meets_goal &&
        std::all_of(now.checks.begin(), now.checks.end(), [&](const ConfirmingRun& c) { return met(c.metrics); }))
      now.belief = Belief::confirmed;
    if (!winner || now.better_than(*winner)) winner = std::move(now);
  };
  if (given_cost < never_touched)
    verify(with_waveforms(given, {}), given_cost, given_point ? named(*given_point) : std::map<std::string, double>{});
  for (const Evaluation& e : candidates(result.search.improvements)) {
    verify(with_waveforms(baseline_scene, space.waveforms(e.x)), e.value, named(e.x));
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
