// The belief about a tuned device (estimated parameters with standard deviations) as JSON.
#include <utility>

#include "base/require.h"
#include "reports/study_members.h"
#include "reports/tuning_report.h"

namespace softland {
namespace {

using nlohmann::json;

json normal_json(const NormalBelief& belief) {
  json covariance = json::array();
  for (Eigen::Index k = 0; k < belief.covariance.rows(); ++k)
    covariance.push_back(std::vector<double>(belief.covariance.row(k).begin(), belief.covariance.row(k).end()));
  return {{"mean", std::vector<double>(belief.mean.begin(), belief.mean.end())}, {"covariance", std::move(covariance)}};
}

NormalBelief normal_of(const json& written) {
  const auto mean = written.at("mean").get<std::vector<double>>();
  const auto rows = written.at("covariance").get<std::vector<std::vector<double>>>();
  const auto size = static_cast<Eigen::Index>(mean.size());
  NormalBelief belief{.mean = Eigen::Map<const Eigen::VectorXd>(mean.data(), size), .covariance = Eigen::MatrixXd(size, size)};
  require(rows.size() == mean.size(), "its belief has as many rows as coordinates");
  for (Eigen::Index k = 0; k < size; ++k) {
    const std::vector<double>& row = rows[static_cast<std::size_t>(k)];
    require(row.size() == mean.size(), "its belief has as many columns as coordinates");
    belief.covariance.row(k) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), size);
  }
  return belief;
}

}  // namespace

TunedBelief read_belief(const json& coordinates) {
  try {
    return {.prior = normal_of(coordinates.at("prior")), .posterior = normal_of(coordinates.at("posterior"))};
  } catch (const json::exception&) {
    throw InvalidInput("holds no belief about a device that was tuned");
  }
}

json belief_json(const TunedBelief& belief) {
  return {{"prior", normal_json(belief.prior)}, {"posterior", normal_json(belief.posterior)}};
}

TunedBelief tuned_belief(const json& written) {
  return read_belief(internal::value_at(internal::value_at(written, "belief"), "coordinates"));
}

}  // namespace softland
