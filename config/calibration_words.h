// What is measured on every device, from words: "Vdp,frequency:0.5 %", and " in 8 classes" where devices are sorted.
#pragma once

#include <string>

#include "config/scene.h"

namespace softland {

/// Puts it in the place of the [calibration] of the scene: "none" takes that out, and an empty text leaves it. Throws
/// InvalidRequest of the field `calibrate`.
void set_calibration(SceneFile& file, const std::string& words);

}  // namespace softland
