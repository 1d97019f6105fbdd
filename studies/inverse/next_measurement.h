// Measurements that a laboratory could make next, with their usual errors.
#pragma once

#include <string>
#include <vector>

#include "studies/devices/instruments.h"

namespace softland {

struct PossibleMeasurement {
  std::string name;  ///< name, such as "closing time at 22 V"
  Instrument instrument;
  double error = 0;           ///< standard deviation of the measurement error [SI unit], or
  double relative_error = 0;  ///< standard deviation of the measurement error over the value
};

/// Returns the possible measurements on devices of this scene.
[[nodiscard]] std::vector<PossibleMeasurement> possible_measurements(const PreparedScene& scene);

}  // namespace softland
