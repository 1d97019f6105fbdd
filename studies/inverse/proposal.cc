#include "studies/inverse/proposal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/executor.h"
#include "base/random.h"
#include "base/require.h"
#include "optimizers/problem.h"
#include "sampling/statistics.h"
#include "studies/closing/plain_step.h"

namespace softland {

LandingCost landing_cost(const PredictedClosing& closing, const TuningScales& s) {
  constexpr double time_price = 0.34, free_time = 0.88, contact_price = 0.02, late_price = 10, margin = 0.99;
  if (!closing.closes()) return {.landing = not_landed};
  const double middle = std::sqrt(s.rebound * s.gap / 20), height = closing.highest;
  const double of_touch = time_price * std::max(0.0, closing.touch / s.closing_time - free_time);
  const double of_contact =
      std::isnan(s.permanent_contact) ? of_touch : contact_price * std::max(0.0, closing.stays_from() / s.permanent_contact - 1);
  return {.landing = (height / (height + middle) + height / (height + s.rebound)) / 2 + 10 * height / s.gap,
          .time = std::min(of_touch, of_contact) + late_price * std::max(0.0, closing.touch / (margin * s.latest_touch) - 1)};
}

namespace {

std::string families_for(const TuningModel& scene) {
  if (scene.approach() == Approach::quasi_static) return std::string(quasi_static_family);
  const PreparedScene& p = scene.nominal();
  const Actuator actuator = scene.options().actuator;
  std::string text = "catch";
  if (actuator == Actuator::pzt) return text;
  for (const std::string& name : braking_electrodes(p)) text += "," + name + "=pulse";
  if (actuator == Actuator::both) text += ",pzt=pulse";
  return text;
}

bool ends_with(const std::string& name, std::string_view ending) { return name.ends_with(ending); }

}  // namespace

TuningSpace::TuningSpace(const TuningModel& scene) : scene_(&scene) {
  const PreparedScene& p = scene.nominal();
  SearchSpace space(p, scene.options().actuator, families_for(scene), scene.scales().closing_time);
  if (scene.approach() == Approach::quasi_static) {
    space = space.paced(scene.scales().permanent_contact);
    joint_ = *space.quasi_static();
  }
  drives_ = space.drives();
  starts_ = space.starts();
  others_ = p.drives.waveforms();
  for (const auto& [drive, waveform] : plain_step(p, scene.options().actuator)) others_[drive] = waveform;
  describe();
}

void TuningSpace::describe() {
  variables_.clear();
  coarse_.clear();
  of_electrode_.clear();
  if (joint_) variables_ = joint_->variables();
  for (const Variable& variable : variables_) {
    coarse_.push_back(false);
    of_electrode_.push_back(!variable.name.starts_with(piezo_drive) && !ends_with(variable.name, "_s"));
  }
  for (const DriveSearch& drive : drives_) {
    for (Variable variable : drive.variables) {
      const std::string& name = variable.name;
      if (name == "edge_s") variable.upper = variable.lower;
      coarse_.push_back(name == "edge_s" || name == "level_3_V" || name == "duration_3_s");
      of_electrode_.push_back(drive.drive != piezo_drive && ends_with(name, "_V"));
      variables_.push_back(std::move(variable));
    }
  }
}

TuningSpace TuningSpace::within(double highest, double hold) const {
  TuningSpace own = *this;
  DriveSearch& closing = own.drives_.front();
  if (joint_ || closing.drive == piezo_drive) return own;
  own.highest_ = highest;
  const double most = std::min(closing.limits.max_voltage, highest);
  closing.hold = std::clamp(closing.hold * hold, closing.limits.min_voltage, std::max(closing.limits.min_voltage, most));
  for (Variable& variable : closing.variables) {
    if (ends_with(variable.name, "_V")) variable.upper = std::max(variable.lower, std::min(variable.upper, most));
  }
  own.describe();
  return own;
}

std::vector<std::vector<double>> TuningSpace::starts() const { return starts_; }

std::vector<Waveform> TuningSpace::waveforms(std::vector<double> x) const {
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = std::clamp(x[k], variables_[k].lower, variables_[k].upper);
  DriveWaveforms all = others_;
  if (joint_) {
    for (auto& [drive, waveform] : joint_->waveforms(x)) all[drive] = waveform;
    return scene_->nominal().in_drive_order(all);
  }
  std::size_t begin = 0;
  for (const DriveSearch& drive : drives_) {
    all[drive.drive] = drive.waveform(std::span(x).subspan(begin, drive.variables.size()));
    begin += drive.variables.size();
  }
  return scene_->nominal().in_drive_order(all);
}

std::vector<double> TuningSpace::in_units(std::vector<double> x, const TuningModel::Units& from,
                                          const TuningModel::Units& to) const {
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (ends_with(variables_[k].name, "_s")) x[k] *= to.time / from.time;
    if (of_electrode_[k]) x[k] *= to.volts / from.volts;
    x[k] = std::clamp(x[k], variables_[k].lower, variables_[k].upper);
  }
  return x;
}

bool TuningSpace::is_allowed(const std::vector<Waveform>& waveforms) const {
  const std::vector<std::string> names = scene_->nominal().drive_names();
  return std::ranges::all_of(drives_, [&](const DriveSearch& drive) {
    const auto k = static_cast<std::size_t>(std::ranges::find(names, drive.drive) - names.begin());
    return violation(signal(waveforms[k], drive.before), drive.limits).empty();
  });
}

double TuningSpace::highest_level() const {
  const DriveSearch& closing = drives_.front();
  return closing.drive == piezo_drive ? std::numeric_limits<double>::infinity() : closing.limits.max_voltage;
}

double TuningSpace::largest_factor(const std::vector<Waveform>& waveforms) const {
  const std::vector<std::string> names = scene_->nominal().drive_names();
  double most = std::numeric_limits<double>::infinity();
  for (const DriveSearch& drive : drives_) {
    const auto k = static_cast<std::size_t>(std::ranges::find(names, drive.drive) - names.begin());
    const auto [minimum, maximum] = signal(waveforms[k], drive.before).range();
    const double highest = &drive == &drives_.front() ? std::min(drive.limits.max_voltage, highest_) : drive.limits.max_voltage;
    if (maximum > 0) most = std::min(most, highest / maximum);
    if (minimum < 0) most = std::min(most, drive.limits.min_voltage / minimum);
  }
  return most;
}

OutcomeForecast::OutcomeForecast(const TuningModel& scene, const std::vector<Eigen::VectorXd>& points, Draws& draws,
                                 const Progress& progress)
    : scene_(scene), devices_(scene.devices(points, progress)), progress_(progress) {
  for (std::size_t k = 0; k < devices_.size(); ++k) gains_.push_back(1 + scene.options().laboratory.shot_error * draws.normal());
}

std::vector<PredictedClosing> OutcomeForecast::close(const std::vector<Waveform>& waveforms, std::size_t begin, std::size_t end,
                                                     double gain) const {
  std::vector<PredictedShot> shots;
  for (std::size_t k = begin; k < std::min(end, size()); ++k)
    shots.push_back({.device = &devices_[k], .waveforms = &waveforms, .gain = gain * gains_[k]});
  return scene_.close(shots, progress_);
}

LandingCost OutcomeForecast::expected(const std::vector<Waveform>& waveforms, std::size_t count, double give_up) const {
  constexpr std::size_t first_devices = 8;
  const auto mean = [&](const std::vector<PredictedClosing>& closings) {
    LandingCost sum;
    for (const PredictedClosing& closing : closings) {
      const LandingCost one = landing_cost(closing, scene_.scales());
      sum.landing += one.landing / static_cast<double>(closings.size());
      sum.time += one.time / static_cast<double>(closings.size());
    }
    return sum;
  };
  const bool tries_few = std::isfinite(give_up) && count > first_devices;
  std::vector<PredictedClosing> closings = close(waveforms, 0, tries_few ? first_devices : count);
  if (!tries_few) return mean(closings);
  if (const LandingCost of_few = mean(closings); of_few.total() > give_up) return of_few;
  std::ranges::move(close(waveforms, first_devices, count), std::back_inserter(closings));
  return mean(closings);
}

namespace {

// Returns the root mean square distance of the sample's values from `middle`, on one side of the middle: late contact times
// scatter more than early ones.
double scatter_of(const std::vector<double>& sample, double middle, double side) {
  double squares = 0, count = 0;
  for (const double one : sample) {
    if (side * (one - middle) < 0) continue;
    squares += (one - middle) * (one - middle), ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

}  // namespace

PredictedRecord OutcomeForecast::predicted(const std::vector<Waveform>& waveforms) const {
  constexpr double both_sides = 1.96, unset = Metrics::unset;
  std::vector<double> touches, speeds, heights;
  double bouncing = 0;
  for (const PredictedClosing& closing : close(waveforms, 0, size())) {
    if (!closing.is_seen_to_close()) continue;
    const auto seen = closing.seen();
    touches.push_back(closing.recorded_touch());
    speeds.push_back(seen.speed);
    heights.push_back(closing.highest);
    bouncing += std::ranges::any_of(
        seen.openings, [&](const ContactOpening& o) { return o.end - o.begin >= scene_.options().laboratory.unseen; });
  }
  PredictedRecord record{
      .touch_median = unset, .touch_low = unset, .touch_high = unset, .rebound_median = unset, .rebound_high = unset};
  if (touches.empty()) return record;
  const auto count = static_cast<double>(touches.size());
  record.touches = count / static_cast<double>(size());
  record.bounces = bouncing / count;
  record.touch_median = sample_quantile(touches, 0.5);
  const double error = Likelihood(scene_, {}).touch_deviation(sample_quantile(speeds, 0.5));
  record.touch_low = record.touch_median - both_sides * std::hypot(scatter_of(touches, record.touch_median, -1), error);
  record.touch_high = record.touch_median + both_sides * std::hypot(scatter_of(touches, record.touch_median, 1), error);
  record.rebound_median = sample_quantile(heights, 0.5);
  record.rebound_high = sample_quantile(heights, 0.95);
  return record;
}

double OutcomeForecast::touch_slope(const std::vector<Waveform>& waveforms) const {
  constexpr double apart = 5e-4;
  const std::vector<PredictedClosing> less = close(waveforms, 0, size(), 1 - apart),
                                      more = close(waveforms, 0, size(), 1 + apart);
  std::vector<double> slopes;
  for (std::size_t k = 0; k < less.size(); ++k) {
    if (less[k].is_seen_to_close() && more[k].is_seen_to_close())
      slopes.push_back((more[k].seen().touch - less[k].seen().touch) / (2 * apart));
  }
  return slopes.empty() ? Metrics::unset : sample_quantile(slopes, 0.5);
}

namespace {

// A search for the waveform of least expected cost over the first devices of a forecast.
struct ProposalSearch {
  const char* optimizer;
  std::size_t devices;
  long evaluations;
  double step;  // first step of the search, as a share of the range of each variable
  bool fine;    // true to vary only the waveform variables that affect the closing strongly
};

std::vector<double> found(const TuningSpace& space, const OutcomeForecast& forecast, const std::vector<double>& start,
                          const ProposalSearch& search, double effort, std::uint64_t seed, const Progress& progress,
                          double give_up = std::numeric_limits<double>::infinity()) {
  Problem problem{.variables = space.variables()};
  for (std::size_t k = 0; k < start.size(); ++k) {
    if (search.fine && space.is_coarse(k)) problem.variables[k].lower = problem.variables[k].upper = start[k];
  }
  problem.objective = [&](std::span<const double> x) {
    const std::vector<Waveform> waveforms = space.waveforms({x.begin(), x.end()});
    if (!space.is_allowed(waveforms)) return std::numeric_limits<double>::infinity();
    return forecast.expected(waveforms, search.devices, give_up).total();
  };
  problem.starts = {start};
  const double evaluations = effort * static_cast<double>(search.evaluations);
  const OptimizerResult result = minimize(problem, {.optimizer = search.optimizer,
                                                    .max_evaluations = std::max(1L, std::lround(evaluations)),
                                                    .seed = seed,
                                                    .step = search.step,
                                                    .stop = progress.stop});
  progress.throw_if_stopped();
  return result.x.empty() ? start : result.x;
}

}  // namespace

namespace {

std::vector<CandidateWaveform> searched_recipes(const TuningModel& scene, const TuningSpace& space, std::size_t count,
                                                const Progress& progress) {
  // Scatter of the devices for which recipes (candidate waveforms) are searched, in standard deviations of the prior: of the
  // quantities that change the units of voltage and time, and of the other quantities (nuisances).
  constexpr double narrow = 0.1, narrow_nuisances = 0.5;
  // Limit of levels, as a share of the source's highest level: leaves room for devices that need more.
  constexpr double headroom = 0.92;
  constexpr double hopeless = 0.9;
  constexpr std::array deviations{0.0, -1.0, 1.0, -2.0, 2.0};
  const std::size_t devices = scene.is_in_lanes() ? 48 : 12;
  const long budget = (scene.is_in_lanes() ? 100 : 50) * static_cast<long>(space.variables().size());
  const std::uint64_t seed = scene.options().seed;
  const Eigen::VectorXd& slope = scene.volts_slope();
  Draws draws(seed, std::uint64_t{1} << 40);
  std::vector<Eigen::VectorXd> apart;
  for (std::size_t k = 0; k < devices; ++k) {
    apart.push_back(draws.normals(scene.size()));
    for (Eigen::Index i = 0; i < scene.size(); ++i) apart.back()[i] *= scene.is_nuisance(i) ? narrow_nuisances : narrow;
  }
  std::vector<CandidateWaveform> recipes;
  for (std::size_t n = 0; n < std::min(count, deviations.size()); ++n) {
    progress.tell("recipes", static_cast<double>(n) / static_cast<double>(count));
    const Eigen::VectorXd centre =
        slope.isZero() ? Eigen::VectorXd(slope) : Eigen::VectorXd(deviations[n] / slope.norm() * slope);
    std::vector<Eigen::VectorXd> points = apart;
    for (Eigen::VectorXd& point : points) point += centre;
    const OutcomeForecast forecast(scene, points, draws, progress);
    const TuningModel::Units units = scene.units(centre);
    const TuningSpace limited = space.within(
        std::min(scene.safe_level(
                     {.mean = centre, .covariance = narrow * narrow * Eigen::MatrixXd::Identity(scene.size(), scene.size())}),
                 headroom * units.volts * space.highest_level()),
        units.volts);
    std::vector<Proposal> from;
    const auto add = [&](const std::vector<double>& x) {
      const std::vector<Waveform> waveforms = limited.waveforms(x);
      if (limited.is_allowed(waveforms)) from.push_back({.x = x, .cost = forecast.expected(waveforms, devices)});
    };
    if (n == 0) {
      for (const std::vector<double>& start : limited.starts()) add(limited.in_units(start, {}, {}));
    } else {
      for (const CandidateWaveform& recipe : recipes) add(limited.in_units(recipe.x, units_of(recipe), units));
    }
    std::ranges::stable_sort(from, {}, [](const Proposal& one) { return one.cost.total(); });
    CandidateWaveform best{.approach = scene.approach(),
                           .x = from.empty() ? limited.in_units(space.starts().front(), {}, {}) : from.front().x,
                           .volts = units.volts,
                           .time = units.time,
                           .cost = from.empty() ? not_landed : from.front().cost.total()};
    from.resize(std::min<std::size_t>(from.size(), n == 0 ? 3 : 1));
    run_tasks(from.size(), scene.options().jobs, [&](std::size_t k) {
      from[k].x = found(limited, forecast, from[k].x,
                        {.optimizer = "cma-es", .devices = devices, .evaluations = budget, .step = 0.1, .fine = false},
                        scene.options().effort, random_bits(seed, Stream::tuning, 16 * n + k), progress, hopeless);
      from[k].cost = forecast.expected(limited.waveforms(from[k].x), devices);
    });
    for (const Proposal& end : from) {
      if (end.cost.total() < best.cost) best.x = end.x, best.cost = end.cost.total();
    }
    recipes.push_back(std::move(best));
  }
  return recipes;
}

}  // namespace

std::vector<CandidateWaveform> recipes_of(TuningModel& scene, const Progress& progress) {
  const std::size_t count = scene.volts_slope().isZero() ? 1 : static_cast<std::size_t>(scene.options().most_recipes);
  const std::vector<CandidateWaveform>& known = scene.options().recipes;
  if (known.empty()) {
    constexpr double nothing_costs_less = 0.1;
    const auto searched = [&](Approach approach) {
      scene.choose(approach);
      return searched_recipes(scene, TuningSpace(scene), count, progress);
    };
    if (!scene.has_stable_path()) return searched(Approach::fast);
    std::vector<CandidateWaveform> slow = searched(Approach::quasi_static);
    if (slow.front().cost <= nothing_costs_less) return slow;
    std::vector<CandidateWaveform> fast = searched(Approach::fast);
    if (fast.front().cost < slow.front().cost) return fast;
    scene.choose(Approach::quasi_static);
    return slow;
  }
  require(known.size() == count, [&] { return fmt::format("there are {} recipes; there must be {}", known.size(), count); });
  scene.choose(known.front().approach);
  const std::size_t numbers = TuningSpace(scene).variables().size();
  for (const CandidateWaveform& recipe : known) {
    require(recipe.approach == scene.approach(), "all recipes must have the same approach");
    require(recipe.x.size() == numbers,
            [&] { return fmt::format("a recipe has {} numbers, and must have {}", recipe.x.size(), numbers); });
    require(std::ranges::all_of(recipe.x, [](double x) { return std::isfinite(x); }) && recipe.volts > 0 && recipe.time > 0 &&
                std::isfinite(recipe.volts) && std::isfinite(recipe.time),
            "the numbers of a recipe must be finite, and its units above 0");
  }
  return known;
}

Proposal propose(const TuningModel& scene, const TuningSpace& space, const OutcomeForecast& forecast,
                 const std::vector<std::vector<double>>& candidates, std::uint64_t seed, const Progress& progress) {
  constexpr double far_off = 0.3, not_good = 0.03, hopeless = 0.3;
  const std::size_t all = forecast.size();
  const auto priced = [&](std::vector<double> x) -> Proposal {
    const std::vector<Waveform> waveforms = space.waveforms(x);
    if (!space.is_allowed(waveforms)) return {.x = std::move(x), .cost = {.landing = std::numeric_limits<double>::infinity()}};
    return {.x = std::move(x), .cost = forecast.expected(waveforms, all)};
  };
  std::vector<Proposal> ranked;
  for (const std::vector<double>& x : candidates) ranked.push_back(priced(space.in_units(x, {}, {})));
  std::ranges::stable_sort(ranked, {}, [](const Proposal& one) { return one.cost.total(); });
  Proposal best = ranked.front();
  const auto end_of = [&](const std::vector<double>& start, const ProposalSearch& how, std::uint64_t which) {
    return priced(found(space, forecast, start, how, scene.options().effort, random_bits(seed, Stream::tuning, which), progress));
  };
  const auto take = [&](Proposal end) {
    if (end.cost.total() < best.cost.total()) best = std::move(end);
  };
  const auto search = [&](const ProposalSearch& how, std::uint64_t which) { take(end_of(best.x, how, which)); };
  const double step = best.cost.landing > far_off ? 0.0067 : 0.0027;
  search({.optimizer = "nelder-mead", .devices = 8, .evaluations = 50, .step = step, .fine = true}, 0);
  search({.optimizer = "nelder-mead", .devices = all, .evaluations = 50, .step = step, .fine = true}, 1);
  const auto numbers = static_cast<long>(space.variables().size());
  if (best.cost.landing > not_good)
    search({.optimizer = "nelder-mead", .devices = 12, .evaluations = 12 * numbers, .step = 0.013, .fine = false}, 2);
  if (best.cost.landing > hopeless) {
    const long budget = scene.is_in_lanes() ? 250 : 100;
    const std::vector<std::vector<double>> starts{best.x, ranked[ranked.size() > 1 ? 1 : 0].x};
    std::vector<Proposal> ends(starts.size());
    run_tasks(starts.size(), scene.options().jobs, [&](std::size_t k) {
      ends[k] =
          end_of(starts[k], {.optimizer = "cma-es", .devices = 12, .evaluations = budget, .step = 0.025, .fine = false}, 3 + k);
    });
    for (Proposal& end : ends) take(std::move(end));
  }
  return best;
}

}  // namespace softland
