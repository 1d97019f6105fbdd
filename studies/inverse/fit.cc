#include "studies/inverse/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "base/decompositions.h"
#include "base/require.h"
#include "base/standard_normal.h"
#include "config/assumed_spread.h"
#include "sampling/points.h"
#include "studies/inverse/fit_end.h"
#include "studies/inverse/trace_windows.h"

namespace softland {

double Fit::chi_squared() const {
  return std::accumulate(residuals.begin(), residuals.end(), 0.0,
                         [](double sum, const FitResidual& r) { return sum + r.normalized() * r.normalized(); });
}

double Fit::chi_squared_before() const {
  return std::accumulate(residuals.begin(), residuals.end(), 0.0,
                         [](double sum, const FitResidual& r) { return sum + r.normalized_before() * r.normalized_before(); });
}

std::vector<Fit::FittedKey> Fit::keys(const std::string& device) const {
  std::vector<FittedKey> all;
  for (const SpreadVariable& variable : scene.scene.spread.variables) {
    const auto one = std::ranges::find_if(
        unknowns, [&](const FittedUnknown& u) { return u.name == variable.name && (u.device.empty() || u.device == device); });
    if (one == unknowns.end()) continue;
    for (const VariedKey& key : variable.keys) {
      const bool is_value_already = variable.is_factor && variable.keys.size() == 1;
      const double value = is_value_already ? one->value : DeviceSpread::value(variable, key, one->value);
      all.push_back({.path = key.path, .element = key.element, .value = {.value = value, .dimension = key.measured_in}});
    }
  }
  return all;
}

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Returns the starts of a fit's searches: the nominal device, and points of low discrepancy over the prior.
std::vector<std::vector<double>> starts_of(const FitProblem& problem, const FitOptions& options) {
  const std::size_t n = problem.parameters.size();
  std::vector<std::vector<double>> all{std::vector<double>(n, 0.0)};
  const SamplePoints points(PointSet::sobol, n, options.seed, Stream::fit, std::max<std::size_t>(1, options.starts));
  for (std::size_t k = 1; k < options.starts; ++k) {
    std::vector<double>& z = all.emplace_back(n);
    points.point(k - 1, z);
    for (double& one : z) one = standard_normal_quantile(one);
  }
  return all;
}

// Returns the reasons to doubt the result of a fit, in sentences.
std::vector<std::string> doubts_of(const Fit& fit, const ManyEnds& all, const LeastSquaresEnd& best) {
  constexpr double far = 4;          // permitted distance of a fitted unknown from its prior [standard deviations of the prior]
  constexpr double largest_rms = 3;  // permitted root mean square of a fit's residuals [errors of the data]
  // Another minimum is as good as the best if its cost, half of chi-squared, is larger by at most 2 (two standard deviations).
  constexpr double as_good = 2;
  // Distance from which on another minimum of the fit differs from the best, in standard errors.
  constexpr double standard_errors = 4;
  std::vector<std::string> doubts;
  for (const FittedUnknown& u : fit.unknowns) {
    const double off = std::abs(u.value - u.prior_mean) / u.prior_deviation;
    const std::string device = u.device.empty() ? "" : " of " + u.device;
    if (off > far) doubts.push_back(fmt::format("{}{} is {:.3g} standard deviations away from its prior", u.name, device, off));
  }
  const double rms = std::sqrt(fit.chi_squared() / static_cast<double>(std::max<std::size_t>(1, fit.residuals.size())));
  if (rms > largest_rms) doubts.push_back(fmt::format("the fit does not describe the data: RMS residual {:.3g} sigma", rms));
  const auto differs = [&](const LeastSquaresEnd& end) {
    if (!end.converged || end.x.size() != best.x.size() || !(end.cost <= best.cost + as_good)) return false;
    for (std::size_t i = 0; i < std::min(fit.unknowns.size(), end.x.size()); ++i) {
      const FittedUnknown& u = fit.unknowns[i];
      if (std::abs(end.x[i] - best.x[i]) * u.scale > standard_errors * u.standard_error) return true;
    }
    return false;
  };
  if (std::ranges::any_of(all.ends, differs)) doubts.emplace_back("another minimum describes the data as well");
  return doubts;
}

// One stage of a fit: the problem with the rows of recorded curves (traces) up to some time, and the ends of the searches for
// its solution from several starts.
struct Stage {
  std::unique_ptr<const FitProblem> problem;
  ManyEnds all = {};
};

// True if two searches ended in the same minimum: the distance between their ends is far below the errors from data and prior.
bool is_one_minimum(const LeastSquaresEnd& a, const LeastSquaresEnd& b) {
  // Permitted difference between two ends of one minimum: of each unknown in standard deviations, and of the cost.
  constexpr double apart = 0.1;
  double largest = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i) largest = std::max(largest, std::abs(a.x[i] - b.x[i]));
  return largest <= apart && std::abs(a.cost - b.cost) <= apart;
}

Stage solved(FitProblem problem, const std::vector<std::vector<double>>& starts, const FitOptions& options,
             const Progress& progress) {
  Stage stage{.problem = std::make_unique<const FitProblem>(std::move(problem))};
  stage.all = solve_from([&] { return least_squares_of(*stage.problem); }, starts, options.jobs, is_one_minimum, progress);
  return stage;
}

// Returns the distinct ends of the searches of a stage, the best first, as starts of the next stage. When more rows of the
// recorded curves (traces) are fitted, another of these ends may become the best.
std::vector<std::vector<double>> best_ends(const ManyEnds& all) {
  constexpr std::size_t most = 5;
  std::vector<const LeastSquaresEnd*> ranked;
  for (const LeastSquaresEnd& end : all.ends) {
    if (!end.x.empty()) ranked.push_back(&end);
  }
  std::ranges::stable_sort(ranked, {}, [](const LeastSquaresEnd* end) { return end->cost; });
  std::vector<const LeastSquaresEnd*> distinct;
  for (const LeastSquaresEnd* end : ranked) {
    if (distinct.size() < most &&
        std::ranges::none_of(distinct, [&](const LeastSquaresEnd* other) { return is_one_minimum(*end, *other); }))
      distinct.push_back(end);
  }
  std::vector<std::vector<double>> starts;
  for (const LeastSquaresEnd* end : distinct) starts.push_back(end->x);
  return starts;
}

// Returns, for each measurement that is a curve over time, the first contact time of the nominal design; only rows up to this
// time are fitted at first. NaN for other measurements.
std::vector<double> nominal_touches(const FitProblem& problem, std::size_t measurements) {
  std::vector<double> touches(measurements, Metrics::unset);
  for (const Datum& datum : problem.data) {
    const FitDevice& device = problem.devices[datum.device];
    if (std::isnan(datum.time) || !std::isnan(touches[datum.measurement]) || !device.nominal.model.has_contact()) continue;
    Instrument clock = device.instruments[datum.instrument];
    clock.what = Measurable::closing_time;
    clock.times.clear();
    DeviceReader reader(device.nominal);
    std::vector<double> middle;
    for (const std::size_t p : problem.of_device[datum.device]) middle.push_back(problem.parameters[p].mean);
    if (reader.move_to(middle)) touches[datum.measurement] = reader.read(clock, false).values[0];
  }
  return touches;
}

// The residuals of each recorded curve (trace) in units of the errors, over all used rows or over the rows that were added
// last.
struct TraceMisfit {
  std::vector<double> rms;  // root mean square of the residuals, by measurement; infinite if the prediction fails
  std::vector<double> rows;
};

TraceMisfit misfit(const Stage& stage, std::size_t measurements, const TraceWindows* newest = nullptr) {
  TraceMisfit of{.rms = std::vector<double>(measurements, 0), .rows = std::vector<double>(measurements, 0)};
  const FitProblem& problem = *stage.problem;
  VectorXd values, off = VectorXd::Constant(problem.measured.size(), HUGE_VAL);
  if (stage.all.found() && MeasurementModel(problem).predict(stage.all.ends[stage.all.best].x, values, nullptr))
    off = problem.residuals(values);
  for (std::size_t i = 0; i < problem.data.size(); ++i) {
    const Datum& datum = problem.data[i];
    if (std::isnan(datum.time) || (newest != nullptr && !newest->is_new(datum.measurement, datum.time))) continue;
    of.rms[datum.measurement] += off[static_cast<Index>(i)] * off[static_cast<Index>(i)];
    of.rows[datum.measurement] += 1;
  }
  for (std::size_t m = 0; m < measurements; ++m) of.rms[m] = of.rows[m] > 0 ? std::sqrt(of.rms[m] / of.rows[m]) : 0;
  return of;
}

// Returns, by measurement, whether the model describes the rows of a recorded curve that were added last as well as the earlier
// rows. The root mean square of their residuals may be larger only by chance, up to three standard deviations.
std::vector<bool> described(const TraceMisfit& newest, const TraceMisfit& before) {
  constexpr double least = 0.15, deviations = 3;
  std::vector<bool> all;
  for (std::size_t m = 0; m < newest.rms.size(); ++m) {
    const double chance = std::max(least, deviations / std::sqrt(2 * std::max(1.0, newest.rows[m])));
    all.push_back(newest.rms[m] <= (1 + chance) * std::max(1.0, before.rms[m]));
  }
  return all;
}

// True if the data are linear in the unknowns within the standard errors of the unknowns. After some bounces the data are not
// linear: derivatives of a chaotic motion are valid for tiny steps only, and give standard errors that are far too small.
bool is_linear(const Stage& stage) {
  constexpr double largest = 0.5;  // permitted deviation of the data from linear, in standard deviations
  const FitProblem& problem = *stage.problem;
  const LeastSquaresEnd& end = stage.all.ends[stage.all.best];
  MeasurementModel model(problem);
  VectorXd values, moved;
  MatrixXd slopes;
  if (!model.predict(end.x, values, &slopes)) return false;
  // Factors that convert changes of the data to units of their errors, reduced by the weights of the robust loss.
  const VectorXd weights = problem.weights(problem.residuals(values)).cwiseSqrt().cwiseQuotient(problem.errors);
  const MatrixXd weighted = weights.asDiagonal() * slopes;
  const MatrixXd covariance = estimate(weighted.transpose() * weighted, problem.prior).covariance;
  if (!covariance.allFinite()) return true;
  const MatrixXd steps = cholesky_factor(covariance);
  for (Index k = 0; k < steps.cols(); ++k) {
    const VectorXd z = Eigen::Map<const VectorXd>(end.x.data(), steps.rows()) + steps.col(k);
    if (!model.predict({z.data(), static_cast<std::size_t>(z.size())}, moved, nullptr)) return false;
    if (weights.cwiseProduct(moved - values - slopes * steps.col(k)).norm() > largest) return false;
  }
  return true;
}

}  // namespace

Fit fit(const SceneFile& given, const Bench& bench, const FitOptions& options, const Progress& progress) {
  require(options.starts >= 1 && options.starts <= most_starts,
          [&] { return fmt::format("{} starts: must be from 1 to {}", options.starts, most_starts); });
  require(!bench.measurements.empty(), [&] { return fmt::format("{}: a fit needs at least one measurement", bench.name); });
  SceneFile file = given;
  const bool assumed = options.unknowns.empty() && assume_spread(file);
  const std::size_t measurements = bench.measurements.size();
  const FitProblem whole = with_data(problem_without_data(file, bench, options, progress), bench);
  TraceWindows windows(bench, nominal_touches(whole, measurements));
  Stage stage = solved(with_data(whole, windows.inside()), starts_of(whole, options), options, progress);
  Fit found{.scene = stage.problem->devices.front().nominal, .spread_assumed = assumed};
  found.loss = options.loss;
  found.seed = options.seed;
  for (const FitDevice& device : stage.problem->devices) found.devices.push_back(device.name);
  found.starts = stage.all.ends.size();
  found.minima = stage.all.minima;
  for (const LeastSquaresEnd& end : stage.all.ends) {
    found.converged += end.converged;
    found.costs.push_back(end.x.empty() ? Metrics::unset : end.cost);
  }
  found.found = stage.all.found();
  if (!found.found) return found;
  const TraceMisfit before_touch = misfit(stage, measurements);
  while (windows.grow()) {
    Stage next = solved(with_data(whole, windows.inside()), best_ends(stage.all), options, progress);
    std::vector<bool> goes_on = described(misfit(next, measurements, &windows), before_touch);
    if (!next.all.found() || !is_linear(next)) goes_on.assign(measurements, false);
    if (windows.keep(goes_on)) stage = std::move(next);
  }
  for (std::size_t m = 0; m < measurements; ++m) {
    const BenchMeasurement& one = bench.measurements[m];
    if (!one.times.empty())
      found.traces.push_back({.measurement = m,
                              .what = std::ranges::find(measurables, one.quantity, &MeasurableRow::name)->value,
                              .until = windows.end(m),
                              .recorded = one.times.back()});
  }
  EndOfFit end(*stage.problem, stage.all.ends[stage.all.best], found);
  end.require_all_seen(bench.name);
  end.add_population();
  if (options.suggest) end.add_next(progress);
  found.doubts = doubts_of(found, stage.all, stage.all.ends[stage.all.best]);
  if (found.doubts.empty()) return found;
  for (FittedUnknown& u : found.unknowns) u.standard_error = u.low = u.high = Metrics::unset;
  return found;
}

}  // namespace softland
