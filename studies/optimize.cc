#include "studies/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/engineering.h"
#include "objectives/figures.h"
#include "studies/plain_step.h"
#include "studies/search_setting.h"

namespace softland {
namespace {

constexpr double tight_tolerance = 1e-9;    // of the confirming run
constexpr int more_modes = 2;               // of the confirming run
constexpr std::size_t most_candidates = 8;  // of the search, verified at the most
constexpr std::size_t most_sure = 4;        // more, where those did not stand up
constexpr double distinct = 1.01;           // ratio of the costs of two candidates

// The target's own figure, infinite where the closing has none; of a sum, the mean of figures over those of the baseline, of
// settling over its first touch: it may not settle at all.
double figure(const Aim& aim, const Metrics& m, const Metrics& baseline) {
  const double value = aim.mean([&](Target target) {
    const double own = figure_of(target).value(m);
    const double unit = target == Target::settling ? baseline.initial_contact_time : figure_of(target).value(baseline);
    return aim.is_sum() && unit > 0 ? own / unit : own;
  });
  return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

// How far a candidate is believed.
enum class Belief { touches, settles, lands, meets_goal, confirmed };

// A candidate after its run over the whole window, as its file says, at the accuracy the scene asks for.
struct Verified {
  Prepared scene;
  Closing closing;
  std::vector<ConfirmingRun> checks;
  std::map<std::string, double> parameters;
  double cost = 0;
  double figure = 0;  // the target's own; rebounds that are not significant are equal
  double broken = 0;  // by how much it breaks the conditions
  Belief belief = Belief::touches;

  [[nodiscard]] bool better_than(const Verified& other) const {
    return std::tuple(-static_cast<int>(belief), broken, figure, cost) <
           std::tuple(-static_cast<int>(other.belief), other.broken, other.figure, other.cost);
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
        conditions_(options.conditions),
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
                 .figure = figure(target_, m, baseline_),
                 .broken = broken(conditions_, m),
                 .belief = met(m)                             ? Belief::meets_goal
                           : m.settled && m.bounce_count == 0 ? Belief::lands
                           : m.settled                        ? Belief::settles
                                                              : Belief::touches};
    if (!target_.is_sum() && (target_.is_about(Target::bounce) || target_.is_about(Target::rebound)))
      now.figure = std::max(now.figure, given_.scene.metrics.significant_rebound);
    if (now.belief == Belief::meets_goal || !best_ || now.better_than(*best_)) now.checks = confirm(now.scene);
    if (now.belief == Belief::meets_goal &&
        std::all_of(now.checks.begin(), now.checks.end(), [&](const ConfirmingRun& c) { return met(c.metrics); }))
      now.belief = Belief::confirmed;
    if (!best_ || now.better_than(*best_)) best_ = std::move(now);
  }

  /// The cost of the best so far; infinite where there is none.
  [[nodiscard]] double best_cost() const { return best_ ? best_->cost : std::numeric_limits<double>::infinity(); }
  /// Whether no candidate that costs as much or more can be better.
  [[nodiscard]] bool decided(double cost) const { return best_ && best_->belief == Belief::confirmed && best_->cost <= cost; }

  /// Hands the winner over, where there is one.
  void move_to(OptimizeResult& result) {
    if (!best_) return;
    result.goal_met = best_->belief >= Belief::meets_goal;
    result.confirmed = best_->belief == Belief::confirmed;
    const Metrics& m = best_->closing.metrics;
    result.better_than_baseline = figure(target_, m, baseline_) < figure(target_, baseline_, baseline_);
    for (const Criterion& one : conditions_) {
      if (broken({one}, m) > 0) result.broken_conditions.push_back(one.text);
    }
    result.best_scene = std::move(best_->scene);
    result.best = std::move(best_->closing);
    result.checks = std::move(best_->checks);
    result.parameters = std::move(best_->parameters);
    result.best_cost = best_->cost;
  }

 private:
  // Of a confirming run nothing is known that is not of the motion: its hold force and drives are those of the winner.
  [[nodiscard]] bool met(const Metrics& m) const { return goal_met(target_, m, baseline_) && !(broken(known(m), m) > 0); }
  [[nodiscard]] std::vector<Criterion> known(const Metrics& m) const {
    std::vector<Criterion> all;
    for (const Criterion& one : conditions_) {
      if (std::isfinite(all_figures[one.figure].value(m))) all.push_back(one);
    }
    return all;
  }

  const Prepared& given_;
  const Metrics& baseline_;
  Aim target_;
  std::vector<Criterion> conditions_;
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

long default_budget(const Aim& target, Actuator actuator) {
  const long by_bounce = actuator == Actuator::electrostatic ? 2500 : 10000;
  return target.has_own_cost() ? by_bounce + by_bounce / 2 : by_bounce;
}

bool goal_met(const Aim& target, const Metrics& best, const Metrics& baseline) {
  if (!best.settled || best.bounce_count > 0) return false;
  if (!target.has_own_cost()) return true;
  // The plain step bounces for many times its closing: what counts is how soon contact can begin for good.
  const bool is_settling = !target.is_sum() && target.is_about(Target::settling);
  if (is_settling && std::isfinite(baseline.initial_contact_time))
    return best.permanent_contact_time <= settling_goal * baseline.initial_contact_time;
  return figure(target, best, baseline) < figure(target, baseline, baseline);
}

namespace {

// One search: its objective, and what is told of it while it runs.
class Search {
 public:
  Search(const SearchSetting& setting, const OptimizeOptions& options)
      : setting_(setting),
        options_(options),
        problem_{.variables = setting.space.variables(), .objective = {}, .starts = {}},
        progress_{.baseline_cost = setting.baseline_cost},
        stages_([this](std::span<const double> x) { return setting_.price_at(x, options_.memory); },
                [this](const Evaluation& e) { evaluated(e); }, slopes_of(setting)) {
    for (const Variable& v : problem_.variables) names_.push_back(v.name);
    if (options.on_start) options.on_start(names_);
  }

  // A scene that holds a landing already is refined, and so are landings that other searches have found: they are the first
  // candidates, and the search starts there, or, from those of another family, at the nearest waveform of its own.
  void begin() {
    const std::vector<Signal> drives = setting_.given.signals();
    if (!same_drives(drives, setting_.baseline_scene.signals()))
      refine(drives, setting_.given.drives.waveforms, with_waveforms(setting_.given, {}));
    for (const StartingWaveforms& start : options_.starts) {
      const std::map<std::string, Waveform> searched = setting_.space.searched(start.waveforms);
      refine(signals_of(setting_.drives(searched)), searched, setting_.scene(searched));
    }
    for (std::vector<double>& start : setting_.space.starts()) problem_.starts.push_back(std::move(start));
  }

  OptimizerResult run() {
    return stages_.run(std::move(problem_),
                       {.optimizer = options_.optimizer,
                        .max_evaluations = options_.max_evaluations,
                        .max_seconds = options_.max_seconds,
                        .seed = options_.seed,
                        .jobs = options_.jobs,
                        .stop = options_.stop},
                       options_.target.has_own_cost(), options_.more_evaluations);
  }

  // The best of the landings that were given and of what the search came upon, each verified.
  Verification verified(const std::vector<Evaluation>& improvements) const {
    Verification all(setting_, options_);
    for (const Landing& given : landings_) all.add(given.scene, given.cost, named(given.x));
    std::vector<std::vector<double>> tried;
    for (const Evaluation& e : candidates(improvements)) {
      tried.push_back(e.x);
      all.add(setting_.scene(setting_.space.waveforms(e.x)), e.value, named(e.x));
      if (all.decided(e.value)) break;
    }
    // Where the best by the own cost did not stand up to the full run, others that promise more than what did: the surest
    // landings first, among which are the winners of a search for another target.
    if (options_.target.has_own_cost()) {
      for (std::size_t k = 0; k < most_sure; ++k) {
        const std::optional<Evaluation> e = stages_.surest_below(all.best_cost() / distinct, tried);
        if (!e || !(e->value < never_touched)) break;
        tried.push_back(e->x);
        all.add(setting_.scene(setting_.space.waveforms(e->x)), e->value, named(e->x));
      }
    }
    return all;
  }

 private:
  [[nodiscard]] static PriceSlopes slopes_of(const SearchSetting& setting) {
    using Slope = std::function<std::vector<double>(std::span<const double>)>;
    const auto of = [&](const Aim& aim) -> Slope {
      if (!setting.gradient_refusal(aim).empty()) return {};
      return [&setting, aim](std::span<const double> x) { return setting.gradient_at(x, aim); };
    };
    return {.leading = of(Target::bounce), .own = of(setting.target.has_own_cost() ? setting.target : Aim(Target::bounce))};
  }

  // A landing to begin with. Its parameters are empty where the search cannot describe it.
  struct Landing {
    SceneFile scene;
    double cost;
    std::vector<double> x;
  };

  void refine(const std::vector<Signal>& drives, const std::map<std::string, Waveform>& waveforms, const SceneFile& scene) {
    const double cost = setting_.price(drives).own;
    const std::optional<std::vector<double>> point = setting_.space.parameters(waveforms);
    if (point) {
      problem_.starts.push_back(*point);
    } else if (setting_.space.misfit(waveforms).empty()) {
      problem_.starts.push_back(setting_.space.nearest(waveforms));
    }
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
  TwoStages stages_;
};

}  // namespace

OptimizeResult optimize(const SceneFile& file, const OptimizeOptions& options) {
  static_cast<void>(optimizer_description(options.optimizer));  // throws for an unknown name
  const SearchSetting setting = search_setting(file, options.target, options.actuator, options.family,
                                               {.stop = options.stop, .progress = options.on_preparation}, options.conditions);
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
