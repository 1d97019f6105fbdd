// A picture of a beam as it is built, to scale along it.
#pragma once

#include <string>

#include "model/device.h"

namespace softland {

/// A static SVG document: the beam at rest from above, across the beam to the same scale as along it where that fits, and from
/// the side, heights enlarged, with its sections, layers, holes, electrodes and contacts. Only of a beam.
[[nodiscard]] std::string beam_drawing(const std::string& title, const Device& device);

}  // namespace softland
