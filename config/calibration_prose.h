// Reads a per-device calibration, which is measured on every device before use, from text: "Vdp,frequency:0.5 %", with " in 8
// classes" to sort devices into classes.
#pragma once

#include <string>

#include "config/scene.h"

namespace softland {

/// Replaces [calibration], the per-device calibration of the scene. The words "none" remove the section, and empty words change
/// nothing. Throws InvalidRequest about the option `calibrate`.
void set_calibration(SceneFile& file, const std::string& words);

}  // namespace softland
