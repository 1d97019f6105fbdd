// Reads a per-device calibration from text: the quantities that are measured on every device before use, with the measurement
// errors, "Vdp,frequency:0.5 %" (no error given: 0). The text " in 8 classes" at the end sorts the devices into classes.
#pragma once

#include <string>

#include "config/scene.h"

namespace softland {

/// Replaces [calibration], the per-device calibration of the scene, by that which `words` describe. The text "none" removes the
/// section, and an empty text changes nothing. Throws InvalidRequest about the option `calibrate`.
void set_calibration(SceneFile& file, const std::string& words);

}  // namespace softland
