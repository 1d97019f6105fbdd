// The instrument that reads a measurement of a bench file on a scene.
#pragma once

#include <cstddef>

#include "config/bench.h"
#include "studies/devices/instruments.h"

namespace softland {

/// Returns the instrument that reads row `i` of a measurement, or all of its rows. Throws InvalidInput for a measurement that
/// the scene cannot have.
[[nodiscard]] Instrument instrument_of(const PreparedScene& scene, const BenchMeasurement& measurement, std::size_t i);

}  // namespace softland
