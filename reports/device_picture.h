// Drawings that explain: the switch of a result from the side, and a found waveform with its parameters.
#pragma once

#include <string>

#include "reports/closing_record.h"

namespace softland::internal {

/// Draws the switch at rest as an <svg> element: anchor, beam or plate, piezo layer, electrodes, contact, and the gaps. The
/// length is to scale, heights are exaggerated. Empty where the scene does not describe the switch. Its colours are the page's.
[[nodiscard]] std::string device_picture(const DrawnScene& scene);

/// Draws the waveform of a drive from 0 to where it holds, with the searched parameters written where they act; empty for a
/// drive without searched parameters.
[[nodiscard]] std::string parameter_drawing(const ClosingRecord& result, const std::string& drive);

}  // namespace softland::internal
