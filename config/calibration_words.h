// The per-device calibration, from words: "Vdp,frequency:0.5 %", and " in 8 classes" where devices are sorted.
#pragma once

#include <string>

#include "config/scene.h"

namespace softland {

/// Replaces the [calibration] of the scene: "none" removes it, and an empty text leaves it. Throws InvalidRequest of the field
/// `calibrate`.
void set_calibration(SceneFile& file, const std::string& words);

}  // namespace softland
