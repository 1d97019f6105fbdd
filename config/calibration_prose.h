// Reads a per-device calibration from text: the quantities that are measured on every device before use, with the measurement
// errors, as in "Vdp,frequency:0.5 %"; an error that is not given is 0. With " in 8 classes" at the end, the devices are
// sorted by the measured values into 8 classes, and all devices of a class use one waveform.
#pragma once

#include <string>

#include "config/scene.h"

namespace softland {

/// Replaces [calibration], the per-device calibration of the scene, by that which `words` describe. The text "none" removes the
/// section, and an empty text changes nothing. Throws InvalidRequest about the option `calibrate`.
void set_calibration(SceneFile& file, const std::string& words);

}  // namespace softland
