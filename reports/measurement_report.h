// The results of `softland calibrate`, the value of measuring each device: JSON with SI units in the names, and a table for a
// terminal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/origin.h"
#include "studies/inverse/identification.h"

namespace softland {

struct MeasurementsRecord {
  struct Figure {
    std::string name, unit;
    double nominal = Metrics::unset;  ///< value of the measurable quantity on the nominal device [unit]
    /// Standard deviation of the quantity over the devices that have the quantity, divided by its mean.
    double variation = Metrics::unset;
    double error = 0;         ///< relative error of a measurement of the quantity
    std::size_t devices = 0;  ///< number of devices that have the quantity
  };
  struct Row {
    Prediction found;
    std::vector<std::string> measured;  ///< names of the measured quantities
  };
  Origin origin;
  std::uint64_t seed = 1;
  std::size_t devices = 0;
  bool interrupted = false, spread_assumed = false, drives_piezo = false;
  std::vector<Figure> figures;
  std::vector<Row> references, predictions;
};
[[nodiscard]] MeasurementsRecord record_of(const IdentificationStudy& study, const IdentificationOptions& options,
                                           const std::string& command);

/// Names the members of the JSON.
void members(internal::Archive& a, MeasurementsRecord& record);
[[nodiscard]] nlohmann::json json_of(const MeasurementsRecord& record);
[[nodiscard]] MeasurementsRecord read_measurements(const nlohmann::json& from);
/// Returns a table of at most `most` rows, without pairs of quantities that predict no better than one quantity of the pair
/// alone.
[[nodiscard]] std::string text_of(const MeasurementsRecord& record, std::size_t most = 24);

}  // namespace softland
