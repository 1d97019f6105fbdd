// The instrument for a measurement of a bench file, which lists the measurements of a laboratory on devices.
#pragma once

#include <cstddef>

#include "config/bench.h"
#include "studies/devices/instruments.h"

namespace softland {

/// Returns the instrument that reads row `i` of a measurement, or all rows of a trace or contact record. Throws InvalidInput
/// for a measurement that is impossible for the scene.
[[nodiscard]] Instrument instrument_of(const PreparedScene& scene, const BenchMeasurement& measurement, std::size_t i);

}  // namespace softland
