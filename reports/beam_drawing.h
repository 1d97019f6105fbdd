// A picture of a beam as built, to scale along its length.
#pragma once

#include <string>

#include "model/device.h"

namespace softland {

/// Returns a static SVG document of the beam at rest. The view from above has the same scale across the beam as along it where
/// that fits. The view from the side enlarges heights. Both show sections, layers, holes, electrodes and contacts. Beams only.
[[nodiscard]] std::string beam_drawing(const std::string& title, const Device& device);

}  // namespace softland
