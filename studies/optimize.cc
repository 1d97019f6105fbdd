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

// Verifies candidates, and keeps the best: none is believed before its run over the whole window, nor preferred where a tighter
// integrator or a richer beam undoes its landing.
class Verification {
 public:
  Verification(const SearchSetting& setting, const OptimizeOptions& options)
      : given_(setting.given),
        baseline_(setting.baseline.metrics),
        target_(options.target),
        watch_{.progress = options.on_preparation} {}

  void add(const SceneFile& text, double cost, std::map<std::string, double> parameters) {
    Prepared scene = read_back(text, "best.toml", given_);
    Closing closing = simulate(scene, true, watch_);
    const Metrics& m = closing.metrics;
    Verified now{.scene = std::move(scene),
                 .closing = closing,
                 .checks = {},
                 .parameters = std::move(parameters),
                 .cost = cost,
                 .figure = figure(target_, m),
                 .belief = met(m)      ? Belief::meets_goal
                           : m.settled ? Belief::settles
                                       : Belief::touches};
    if (target_ == Target::bounce || target_ == Target::rebound)
      now.figure = std::max(now.figure, given_.scene.metrics.significant_rebound);
    if (now.belief == Belief::meets_goal || !best_ || now.better_than(*best_)) now.checks = confirm(now.scene);
    if (now.belief == Belief::meets_goal &&
        std::all_of(now.checks.begin(), now.checks.end(), [&](const ConfirmingRun& c) { return met(c.metrics); }))
      now.belief = Belief::confirmed;
    if (!best_ || now.better_than(*best_)) best_ = std::move(now);
  }

  /// Whether no candidate that costs as much or more can be better.
  [[nodiscard]] bool decided(double cost) const { return best_ && best_->belief == Belief::confirmed && best_->cost <= cost; }

  /// Hands the winner over, where there is one.
  void move_to(OptimizeResult& result) {
    if (!best_) return;
    result.goal_met = best_->belief >= Belief::meets_goal;
    result.confirmed = best_->belief == Belief::confirmed;
    result.better_than_baseline = figure(target_, best_->closing.metrics) < figure(target_, baseline_);
    result.best_scene = std::move(best_->scene);
    result.best = std::move(best_->closing);
    result.checks = std::move(best_->checks);
    result.parameters = std::move(best_->parameters);
    result.best_cost = best_->cost;
  }

 private:
  [[nodiscard]] bool met(const Metrics& m) const { return goal_met(target_, m, baseline_); }

  const Prepared& given_;
  const Metrics& baseline_;
  Target target_;
  Watch watch_;
  std::optional<Verified> best_;
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

long default_budget(Target target, Actuator actuator) {
  const long by_bounce = actuator == Actuator::electrostatic ? 2500 : 10000;
  return has_own_cost(target) ? by_bounce + by_bounce / 2 : by_bounce;
}

bool goal_met(Target target, const Metrics& best, const Metrics& baseline) {
  if (!best.settled || best.bounce_count > 0) return false;
  return !has_own_cost(target) || figure(target, best) < figure(target, baseline);
}

namespace {

// One search: its objective, and what is told of it while it runs.
class Search {
 public:
  Search(const SearchSetting& setting, const OptimizeOptions& options)
      : setting_(setting),
        options_(options),
        problem_{.variables = setting.space.variables(), .objective = {}, .starts = {}},
        progress_{.baseline_cost = setting.baseline_cost} {
    for (const Variable& v : problem_.variables) names_.push_back(v.name);
    if (options.on_start) options.on_start(names_);
  }

  // A scene that holds a landing already is refined, and so are landings that other searches have found: they are the first
  // candidates, and where the search can describe them it starts there.
  void begin() {
    const std::vector<Signal> drives = setting_.given.signals();
    if (!same_drives(drives, setting_.baseline_scene.signals()))
      refine(drives, setting_.space.parameters(setting_.given.drives.waveforms), with_waveforms(setting_.given, {}));
    for (const StartingWaveforms& start : options_.starts) {
      const std::map<std::string, Waveform> searched = setting_.space.searched(start.waveforms);
      refine(signals_of(setting_.drives(searched)), setting_.space.parameters(searched), setting_.scene(searched));
    }
    for (std::vector<double>& start : setting_.space.starts()) problem_.starts.push_back(std::move(start));
  }

  OptimizerResult run() {
    TwoStages stages([&](std::span<const double> x) { return setting_.price_at(x, options_.memory); },
                     [&](const Evaluation& e) { evaluated(e); });
    return stages.run(std::move(problem_),
                      {.optimizer = options_.optimizer,
                       .max_evaluations = options_.max_evaluations,
                       .max_seconds = options_.max_seconds,
                       .seed = options_.seed,
                       .jobs = options_.jobs,
                       .stop = options_.stop},
                      has_own_cost(options_.target));
  }

  // The best of the landings that were given and of what the search came upon, each verified.
  Verification verified(const std::vector<Evaluation>& improvements) const {
    Verification all(setting_, options_);
    for (const Landing& given : landings_) all.add(given.scene, given.cost, named(given.x));
    for (const Evaluation& e : candidates(improvements)) {
      all.add(setting_.scene(setting_.space.waveforms(e.x)), e.value, named(e.x));
      if (all.decided(e.value)) break;
    }
    return all;
  }

 private:
  // A landing to begin with. Its parameters are empty where the search cannot describe it.
  struct Landing {
    SceneFile scene;
    double cost;
    std::vector<double> x;
  };

  void refine(const std::vector<Signal>& drives, const std::optional<std::vector<double>>& point, const SceneFile& scene) {
    const double cost = setting_.price(drives).own;
    if (point) problem_.starts.push_back(*point);
    if (!(cost < never_touched)) return;
    landings_.push_back({.scene = scene, .cost = cost, .x = point.value_or(std::vector<double>{})});
    if (progress_.best_cost <= cost) return;
    progress_.best_cost = cost;
    if (options_.on_improvement) options_.on_improvement({.index = given_index, .value = cost, .x = landings_.back().x}, scene);
  }

  void evaluated(const Evaluation& e) {
    ++progress_.evaluations;
    const bool improves = std::isfinite(e.value) && !(progress_.best_cost <= e.value);
    if (improves) progress_.best_cost = e.value;
    if (options_.on_evaluation) options_.on_evaluation(e, progress_);
    if (improves && options_.on_improvement && e.value < never_touched)
      options_.on_improvement(e, setting_.scene(setting_.space.waveforms(e.x)));
  }

  [[nodiscard]] std::map<std::string, double> named(std::span<const double> x) const {
    std::map<std::string, double> parameters;
    for (std::size_t k = 0; k < x.size(); ++k) parameters[names_[k]] = x[k];
    return parameters;
  }

  const SearchSetting& setting_;
  const OptimizeOptions& options_;
  Problem problem_;
  std::vector<std::string> names_;
  std::vector<Landing> landings_;
  OptimizeProgress progress_;
};

}  // namespace

OptimizeResult optimize(const SceneFile& file, const OptimizeOptions& options) {
  static_cast<void>(optimizer_description(options.optimizer));  // throws for an unknown name
  const SearchSetting setting = search_setting(file, options.target, options.actuator, options.family,
                                               {.stop = options.stop, .progress = options.on_preparation});
  setting.check_starts(options.starts);
  Search search(setting, options);
  search.begin();
  OptimizeResult result{.scene = setting.given, .baseline_scene = setting.baseline_scene, .baseline = setting.baseline};
  result.baseline_cost = setting.baseline_cost;
  result.variables = setting.space.variables();
  result.search = search.run();
  search.verified(result.search.improvements).move_to(result);
  return result;
}

}  // namespace softland
