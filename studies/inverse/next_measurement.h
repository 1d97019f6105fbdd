// Measurements that a laboratory could make next, with their usual errors.
#pragma once

#include <string>
#include <vector>

#include "studies/devices/instruments.h"

namespace softland {

struct PossibleMeasurement {
  std::string name;  ///< name of the measurement, such as "closing time at 22 V"
  Instrument instrument;
  double error = 0;           ///< standard deviation of the measurement error [SI unit], for an absolute error
  double relative_error = 0;  ///< standard deviation of the measurement error as a share of the value, for a relative error
};

/// Returns the measurements that a laboratory could make on devices of this scene.
[[nodiscard]] std::vector<PossibleMeasurement> possible_measurements(const PreparedScene& scene);

}  // namespace softland
