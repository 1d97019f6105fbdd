// Draws a beam to scale along its length.
#pragma once

#include <string>

#include "model/device.h"

namespace softland {

/// Returns a static SVG document of the beam at rest; the device must have a beam. The view from above is to scale across the
/// beam too, if that fits. The view from the side enlarges heights. Both views show sections, layers, anchors, electrodes and
/// contacts, with the names of the last three and of the piezo layer; the view from above also shows holes.
[[nodiscard]] std::string beam_drawing(const std::string& title, const Device& device);

}  // namespace softland
