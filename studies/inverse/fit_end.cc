#include "studies/inverse/fit_end.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/require.h"
#include "studies/inverse/next_measurement.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double half_width_95 = 1.959963984540054;

}  // namespace

EndOfFit::EndOfFit(const FitProblem& problem, const LeastSquaresEnd& end, Fit& fit)
    : problem_(problem),
      fit_(fit),
      model_(problem),
      z_(Eigen::Map<const VectorXd>(end.x.data(), static_cast<Index>(end.x.size()))) {
  VectorXd values;
  MatrixXd slopes;
  require(model_.predict(end.x, values, &slopes), "the fitted device cannot be read");
  residuals_ = problem_.residuals(values);
  slopes_ = problem_.errors.cwiseInverse().asDiagonal() * slopes;
  add_residuals(values);
  fit_.estimate = estimate(slopes_.transpose() * problem_.weights(residuals_).asDiagonal() * slopes_, problem_.prior);
  if (problem_.devices.size() > 1) fit_.estimate.weak = weak_of_a_device();
  add_unknowns();
}

void EndOfFit::require_all_seen(const std::string& bench) const {
  for (std::size_t i = 0; i < problem_.parameters.size(); ++i) {
    const FitParameter& p = problem_.parameters[i];
    require_request(p.has_prior || !slopes_.col(static_cast<Index>(i)).isZero(0), [&] {
      return fmt::format("{} {}: no measurement of {} depends on it: leave it out, or give it an entry of [spread] as its prior",
                         requested("unknown"), fit_.scene.scene.spread.variables[p.variable].name, bench);
    });
  }
}

void EndOfFit::add_residuals(const VectorXd& values) {
  VectorXd before;
  const std::vector<double> nominal(problem_.parameters.size(), 0.0);
  const bool known = model_.predict(nominal, before, nullptr);
  for (Index i = 0; i < values.size(); ++i) {
    const Datum& datum = problem_.data[static_cast<std::size_t>(i)];
    const FitDevice& device = problem_.devices[datum.device];
    const Instrument& instrument = device.instruments[datum.instrument];
    FitResidual one{.measurement = datum.measurement,
                    .device = device.name,
                    .what = instrument.what,
                    .drive = device.nominal.drive_names()[instrument.drive],
                    .level = {},
                    .time = {},
                    .measured = problem_.measured[i],
                    .error = problem_.errors[i],
                    .before = known ? before[i] : Metrics::unset,
                    .after = values[i]};
    if (instrument.level != 0) one.level = instrument.level;
    if (!instrument.times.empty()) one.time = instrument.times[static_cast<std::size_t>(datum.row)];
    fit_.residuals.push_back(one);
  }
}

// Returns the weak directions of the Fisher information averaged over the devices, in the unknowns of the first device. A
// direction that is weak on one device is weak on all devices, with different components.
std::vector<WeakDirection> EndOfFit::weak_of_a_device() const {
  const auto n = static_cast<Index>(problem_.parameters.size());
  const std::vector<std::size_t>& first = problem_.of_device.front();
  MatrixXd together = MatrixXd::Zero(n, static_cast<Index>(first.size()));
  for (const std::vector<std::size_t>& own : problem_.of_device) {
    for (std::size_t v = 0; v < own.size(); ++v) together(static_cast<Index>(own[v]), static_cast<Index>(v)) = 1;
  }
  std::vector<WeakDirection> all =
      weak_directions(together.transpose() * fit_.estimate.data * together / static_cast<double>(problem_.devices.size()));
  for (WeakDirection& weak : all) {
    const VectorXd by_variable = weak.direction;
    weak.direction = VectorXd::Zero(n);
    for (std::size_t v = 0; v < first.size(); ++v)
      weak.direction[static_cast<Index>(first[v])] = by_variable[static_cast<Index>(v)];
    for (std::size_t& unknown : weak.unknowns) unknown = first[unknown];
  }
  return all;
}

void EndOfFit::add_unknowns() {
  const DeviceSpread& spread = fit_.scene.scene.spread;
  for (std::size_t i = 0; i < problem_.parameters.size(); ++i) {
    const FitParameter& p = problem_.parameters[i];
    const SpreadVariable& variable = spread.variables[p.variable];
    FittedUnknown one{.name = variable.name,
                      .device = p.device ? problem_.devices[*p.device].name : "",
                      .unit = variable.is_factor ? "" : variable.keys.front().unit};
    // A factor of a single key is shown as the value of that key.
    const bool as_value = variable.is_factor && variable.keys.size() == 1;
    const double unit = as_value ? variable.keys.front().nominal : 1;
    if (as_value) one.unit = variable.keys.front().unit;
    one.nominal = as_value ? unit : variable.nominal();
    one.scale = std::abs(unit) * p.scale;
    one.value = unit * (p.mean + p.scale * z_[static_cast<Index>(i)]);
    one.standard_error = one.scale * fit_.estimate.deviation(i);
    one.low = one.value - half_width_95 * one.standard_error;
    one.high = one.value + half_width_95 * one.standard_error;
    if (p.has_prior) one.prior_mean = unit * p.mean, one.prior_deviation = one.scale;
    fit_.unknowns.push_back(std::move(one));
  }
}

void EndOfFit::add_next(const Progress& progress) {
  const std::vector<PossibleMeasurement> all = possible_measurements(fit_.scene);
  const std::span<const double> z(z_.data(), static_cast<std::size_t>(z_.size()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    progress.throw_if_stopped();
    progress.tell("further measurements", static_cast<double>(k) / static_cast<double>(all.size()));
    std::vector<VectorXd> slopes;
    double error = all[k].error;
    for (std::size_t d = 0; d < problem_.devices.size(); ++d) {
      const auto reading = model_.predict(d, z, all[k].instrument);
      if (!reading) continue;
      if (all[k].relative_error > 0) error = all[k].relative_error * std::abs(reading->value);
      slopes.push_back(reading->slopes / error);
    }
    if (slopes.empty()) continue;
    NextMeasurement next{.name = all[k].name, .what = all[k].instrument.what, .level = {}, .error = error};
    if (all[k].instrument.level != 0) next.level = all[k].instrument.level;
    next.reduction = fit_.estimate.reduction(slopes);
    fit_.next.push_back(std::move(next));
  }
  std::ranges::stable_sort(fit_.next, [](const auto& a, const auto& b) { return a.reduction > b.reduction; });
}

void EndOfFit::add_population() {
  if (problem_.devices.size() < 2) return;
  FittedPopulation found;
  const DeviceSpread& spread = fit_.scene.scene.spread;
  for (std::size_t v = 0; v < spread.variables.size(); ++v) {
    if (problem_.parameters[problem_.of_device[0][v]].device)
      found.variables.push_back(v), found.names.push_back(spread.variables[v].name);
  }
  if (found.variables.empty()) return;
  const auto n = static_cast<Index>(found.variables.size());
  std::vector<KnownDevice> devices;
  const VectorXd weights = problem_.weights(residuals_);
  for (std::size_t d = 0; d < problem_.devices.size(); ++d) {
    std::vector<Index> places;
    for (const std::size_t v : found.variables) places.push_back(static_cast<Index>(problem_.of_device[d][v]));
    const MatrixXd own = slopes_(Eigen::all, places);
    const MatrixXd weighted = own.transpose() * weights.asDiagonal();
    devices.push_back({.data = weighted * own, .target = weighted * (own * z_(places) - residuals_)});
  }
  const NormalBelief population = population_of(devices, NormalBelief::standard(n));
  found.correlation = correlation_of(population.covariance);
  for (Index i = 0; i < n; ++i) {
    const FitParameter& p = problem_.parameters[problem_.of_device[0][found.variables[static_cast<std::size_t>(i)]]];
    found.mean.push_back(p.mean + p.scale * population.mean[i]);
    found.deviation.push_back(p.scale * std::sqrt(population.covariance(i, i)));
  }
  fit_.population = std::move(found);
}

}  // namespace softland
