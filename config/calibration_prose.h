// Reads from text which quantities a per-device calibration measures on every device, with the measurement errors: "Vdp,
// frequency:0.5 %" (no error given: 0), with " in 8 classes" to sort the devices into classes.
#pragma once

#include <string>

#include "config/scene.h"

namespace softland {

/// Replaces [calibration], the per-device calibration of the scene, by that which `words` describe. The text "none" removes the
/// section, and an empty text changes nothing. Throws InvalidRequest about the option `calibrate`.
void set_calibration(SceneFile& file, const std::string& words);

}  // namespace softland
