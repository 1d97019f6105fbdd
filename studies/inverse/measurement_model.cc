#include "studies/inverse/measurement_model.h"

#include <memory>
#include <vector>

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

MeasurementModel::MeasurementModel(const FitProblem& problem) : problem_(problem) {
  for (const FitDevice& device : problem.devices) readers_.emplace_back(device.nominal);
}

bool MeasurementModel::predict(std::span<const double> z, VectorXd& values, MatrixXd* slopes) {
  std::vector<std::vector<DeviceReader::Reading>> all(problem_.devices.size());
  for (std::size_t d = 0; d < all.size(); ++d) {
    if (!move_to(d, z)) return false;
    for (const Instrument& instrument : problem_.devices[d].instruments) {
      const DeviceReader::Reading& last = all[d].emplace_back(readers_[d].read(instrument, slopes != nullptr));
      if (!last.values.allFinite() || (slopes != nullptr && !last.slopes.allFinite())) return false;
    }
  }
  values.resize(problem_.measured.size());
  if (slopes != nullptr) slopes->resize(values.size(), static_cast<Index>(problem_.parameters.size()));
  for (Index i = 0; i < values.size(); ++i) {
    const Datum& datum = problem_.data[static_cast<std::size_t>(i)];
    const DeviceReader::Reading& reading = all[datum.device][datum.instrument];
    values[i] = reading.values[datum.row];
    if (slopes != nullptr) slopes->row(i) = slopes_by_z(datum.device, reading, datum.row);
  }
  return true;
}

std::optional<MeasurementModel::Prediction> MeasurementModel::predict(std::size_t device, std::span<const double> z,
                                                                      const Instrument& instrument) {
  if (!move_to(device, z)) return {};
  const DeviceReader::Reading reading = readers_[device].read(instrument, true);
  if (!reading.values.allFinite() || reading.slopes.size() == 0 || !reading.slopes.allFinite()) return {};
  return Prediction{.value = reading.values[0], .slopes = slopes_by_z(device, reading, 0)};
}

bool MeasurementModel::move_to(std::size_t device, std::span<const double> z) {
  std::vector<double> values;
  for (const std::size_t p : problem_.of_device[device])
    values.push_back(problem_.parameters[p].mean + problem_.parameters[p].scale * z[p]);
  return readers_[device].move_to(values);
}

VectorXd MeasurementModel::slopes_by_z(std::size_t device, const DeviceReader::Reading& reading, Index row) const {
  VectorXd slopes = VectorXd::Zero(static_cast<Index>(problem_.parameters.size()));
  const std::vector<std::size_t>& own = problem_.of_device[device];
  for (std::size_t v = 0; v < own.size(); ++v)
    slopes[static_cast<Index>(own[v])] = reading.slopes(row, static_cast<Index>(v)) * problem_.parameters[own[v]].scale;
  return slopes;
}

LeastSquares least_squares_of(const FitProblem& problem) {
  const auto model = std::make_shared<MeasurementModel>(problem);
  const auto data = problem.measured.size(), n = problem.prior.rows();
  return {.unknowns = problem.parameters.size(),
          .residuals = problem.data.size() + problem.parameters.size(),
          .robust = problem.data.size(),
          .loss = problem.loss,
          .evaluate = [&problem, model, data, n](std::span<const double> z, std::span<double> residuals, double* jacobian) {
            VectorXd values;
            MatrixXd slopes;
            if (!model->predict(z, values, jacobian != nullptr ? &slopes : nullptr)) return false;
            Eigen::Map<VectorXd> all(residuals.data(), data + n);
            all.head(data) = problem.residuals(values);
            all.tail(n) = problem.prior_root * Eigen::Map<const VectorXd>(z.data(), n);
            if (jacobian == nullptr) return true;
            Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> rows(jacobian, data + n, n);
            rows.topRows(data) = slopes.array().colwise() / problem.errors.array();
            rows.bottomRows(n) = problem.prior_root;
            return true;
          }};
}

}  // namespace softland
