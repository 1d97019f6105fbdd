#include "studies/devices/box_and_chaos.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include "base/standard_normal.h"
#include "optimizers/problem.h"
#include "sampling/polynomial_chaos.h"
#include "sampling/statistics.h"

namespace softland {
namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();
constexpr double not_closed =
    std::numeric_limits<double>::lowest();  // value of the function to minimise for a device that does not close

/// Devices in the box of varied quantities, described as points: standard normal numbers, one per quantity.
class Box {
 public:
  Box(const Ensemble& ensemble, const EnsembleDrive& drive, const EnsembleRun& run, const std::atomic<bool>* stop)
      : ensemble_(&ensemble), drives_{drive}, closer_(ensemble.nominal(), drives_, one_at_a_time(run), stop) {}

  [[nodiscard]] BoxDevice device(std::span<const double> z, const Figure& figure) const {
    BoxDevice found;
    for (const double of_quantity : z) found.values.push_back(standard_normal_cdf(of_quantity));
    ensemble_->nominal().scene.spread.to_values(found.values);
    const SampledDevice device = DeviceBuilder(*ensemble_).device(found.values);
    found.outcome = closer_({&device, 1}, 0).front().front();
    found.figure = found.outcome.of(figure);
    return found;
  }

 private:
  static EnsembleRun one_at_a_time(EnsembleRun run) {
    run.vectors = Vectors::none;
    return run;
  }

  const Ensemble* ensemble_;
  std::vector<EnsembleDrive> drives_;  // set of waveforms of the closings, a member since `closer_` keeps a reference to it
  DeviceCloser closer_;
};

/// The devices of a sample that are in the box of varied quantities.
struct SampledInside {
  std::vector<std::size_t> devices;
  std::vector<std::vector<double>> z;
};

SampledInside sampled_inside(const Ensemble& ensemble, std::size_t sampled, double half_width) {
  SampledInside inside;
  for (std::size_t k = 0; k < sampled; ++k) {
    std::vector<double> z = ensemble.point(k);
    for (double& of_quantity : z) of_quantity = standard_normal_quantile(of_quantity);
    if (std::any_of(z.begin(), z.end(), [&](double x) { return std::abs(x) > half_width; })) continue;
    inside.devices.push_back(k);
    inside.z.push_back(std::move(z));
  }
  return inside;
}

/// Returns starts for a search: the middle of the box of varied quantities, and all its corners if their evaluation takes at
/// most a fifth of the evaluations.
std::vector<std::vector<double>> corners(std::size_t d, double half_width, std::size_t evaluations) {
  std::vector<std::vector<double>> points{std::vector<double>(d, 0)};
  constexpr std::size_t most_bits = 16;
  if (d > most_bits || 5 * (std::size_t{1} << d) > evaluations) return points;
  for (std::size_t corner = 0; corner < (std::size_t{1} << d); ++corner) {
    std::vector<double>& z = points.emplace_back(d, half_width);
    for (std::size_t i = 0; i < d; ++i) {
      if ((corner >> i & 1) != 0) z[i] = -half_width;
    }
  }
  return points;
}

Interval range_of(const std::vector<double>& figures) {
  if (figures.empty()) return {};
  const auto [least, most] = std::minmax_element(figures.begin(), figures.end());
  return {.low = *least, .high = *most};
}

/// Returns the share of a figure's variance that its polynomials predict, 1 - sum (y - prediction)^2 / sum (y - mean)^2.
double predicted_share(const PolynomialChaos& chaos, const Eigen::MatrixXd& points, const std::vector<double>& figures) {
  const double mean = sample_mean(figures);
  double missed = 0, all = 0;
  for (std::size_t j = 0; j < figures.size(); ++j) {
    const Eigen::RowVectorXd u = points.row(static_cast<Eigen::Index>(j));
    missed += std::pow(figures[j] - chaos({u.data(), static_cast<std::size_t>(u.size())}), 2);
    all += std::pow(figures[j] - mean, 2);
  }
  return all > 0 ? 1 - missed / all : Metrics::unset;
}

/// Inputs (varied quantities) and outputs (values of a figure) of those devices with indices in [first, last) that have the
/// figure.
struct TrainingSet {
  Eigen::MatrixXd points;
  std::vector<double> figures;
};
TrainingSet training_set(const Ensemble& ensemble, const DriveRobustness& drive, const Figure& figure, std::size_t first,
                         std::size_t last) {
  std::vector<std::vector<double>> points;
  TrainingSet training;
  for (std::size_t k = first; k < last; ++k) {
    const double value = drive.outcomes[k].of(figure);
    if (!std::isfinite(value)) continue;
    training.figures.push_back(value);
    points.push_back(ensemble.point(k));
  }
  training.points.resize(static_cast<Eigen::Index>(points.size()),
                         static_cast<Eigen::Index>(ensemble.nominal().scene.spread.variables.size()));
  for (std::size_t j = 0; j < points.size(); ++j) {
    for (std::size_t i = 0; i < points[j].size(); ++i)
      training.points(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = points[j][i];
  }
  return training;
}

FigureChaos chaos_of(const Ensemble& ensemble, const DriveRobustness& drive, std::string_view key, std::size_t most_fitted) {
  const DeviceSpread& spread = ensemble.nominal().scene.spread;
  const Figure& figure = figure_of(key);
  const std::size_t fitted_devices = std::min(most_fitted, drive.outcomes.size());
  const TrainingSet training = training_set(ensemble, drive, figure, 0, fitted_devices);
  FigureChaos found{.key = key, .fitted = training.figures.size()};
  // Least number of devices to which polynomials are fitted: two for each part of the cross-validation.
  constexpr std::size_t least_fitted = 20;
  if (found.fitted < least_fitted) return found;
  std::vector<Germ> germs_of_variables;
  for (const SpreadVariable& variable : spread.variables) {
    const DistributionKind kind = variable.distribution.kind();
    const bool normal = spread.copula || kind == DistributionKind::normal || kind == DistributionKind::lognormal;
    germs_of_variables.push_back(normal ? Germ::normal : Germ::uniform);
  }
  const PolynomialChaos chaos(germs_of_variables, training.points, training.figures);
  found.degree = chaos.degree();
  found.terms = chaos.terms();
  found.q2 = chaos.q2();
  found.mean = chaos.mean();
  found.standard_deviation = std::sqrt(chaos.variance());
  const TrainingSet others = training_set(ensemble, drive, figure, fitted_devices, drive.outcomes.size());
  found.unseen = others.figures.size();
  if (found.unseen >= least_fitted) found.q2_unseen = predicted_share(chaos, others.points, others.figures);
  constexpr std::uint64_t predictions = 8192;
  const SamplePoints points(PointSet::sobol, germs_of_variables.size(), 1, Stream::spread, predictions);
  std::vector<double> predicted, u(germs_of_variables.size());
  for (std::uint64_t k = 0; k < predictions; ++k) {
    points.point(k, u);
    predicted.push_back(chaos(u));
  }
  found.quantile_95 = sample_quantile(predicted, 0.95);
  return found;
}

}  // namespace

double box_half_width(std::size_t d) {
  const double of_each = std::pow(box_share, 1 / static_cast<double>(d));
  return standard_normal_quantile((1 + of_each) / 2);
}

BoxAndChaos box_and_chaos(const PreparedScene& nominal, const DriveRobustness& drive, const RobustnessOptions& options,
                          const BoxAndChaosOptions& effort, const Progress& progress) {
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  const std::size_t d = nominal.scene.spread.variables.size();
  BoxAndChaos found{.half_width = box_half_width(d)};
  const SampledInside inside = sampled_inside(ensemble, drive.outcomes.size(), found.half_width);
  found.sampled_inside = inside.devices.size();
  const Box box(ensemble, internal::exactly_measured(nominal, drive), internal::run_of(nominal, options), progress.stop);
  Problem problem;
  for (const SpreadVariable& variable : nominal.scene.spread.variables)
    problem.variables.push_back({.name = variable.name, .lower = -found.half_width, .upper = found.half_width});
  const std::vector<std::vector<double>> middle_and_corners = corners(d, found.half_width, effort.closings_per_search);
  const double searches = 2.0 * explained_figures.size();

  for (const std::string_view key : explained_figures) {
    const Figure& figure = figure_of(key);
    std::vector<double> sampled;
    for (const std::size_t k : inside.devices) sampled.push_back(drive.outcomes[k].of(figure));
    FigureRange range{.key = key, .least = {}, .most = {}, .of_sample = range_of(sampled)};
    for (const double sign : {1.0, -1.0}) {
      problem.starts = middle_and_corners;
      if (!sampled.empty()) {  // the best device of the sample is a start of the search; ties are broken arbitrarily
        const auto best =
            std::min_element(sampled.begin(), sampled.end(), [&](double a, double b) { return sign * a < sign * b; });
        problem.starts.push_back(inside.z[static_cast<std::size_t>(best - sampled.begin())]);
      }
      problem.objective = [&](std::span<const double> z) {
        const double value = sign * box.device(z, figure).figure;
        return value == -no_bound ? not_closed : value;
      };
      OptimizerOptions search{
          .max_evaluations = static_cast<long>(effort.closings_per_search), .jobs = options.jobs, .stop = progress.stop};
      search.target = not_closed;  // the search ends at a device that does not close, since no device is worse
      const OptimizerResult result = minimize(problem, search);
      if (progress.stopped()) return {.why_none = "interrupted"};
      found.closings += result.evaluations;
      if (!result.x.empty()) (sign > 0 ? range.least : range.most) = box.device(result.x, figure);
      progress.tell("worst and best devices", (2.0 * static_cast<double>(found.ranges.size()) + (sign > 0 ? 1 : 2)) / searches);
    }
    found.ranges.push_back(std::move(range));
  }
  for (const std::string_view key : explained_figures) found.chaos.push_back(chaos_of(ensemble, drive, key, effort.most_fitted));
  const std::size_t fitted_devices = std::min(effort.most_fitted, drive.outcomes.size());
  found.left_out = fitted_devices - found.chaos.front().fitted;
  return found;
}

SceneFile scene_of_device(const PreparedScene& nominal, const DriveRobustness& drive, const BoxDevice& device,
                          const RobustnessOptions& options) {
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  DriveRobustness exact{.name = drive.name, .waveforms = drive.waveforms};
  exact.known = internal::exactly_measured(nominal, drive).known;
  return internal::scene_of_values(ensemble, exact, device.values, options.seed, 0);
}

}  // namespace softland
