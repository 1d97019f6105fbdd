// Drawings for explanation: the switch of a result from the side, and a found waveform with its parameters.
#pragma once

#include <string>

#include "reports/closing_record.h"

namespace softland::internal {

/// Draws the switch at rest as an <svg> element: anchor, beam or plate, piezo layer, electrodes, contact, and the gaps. The
/// length is to scale, heights are exaggerated. Empty if the scene does not describe the switch. The colours come from the CSS
/// of the page.
[[nodiscard]] std::string device_picture(const DrawnScene& scene);

/// Draws the waveform of an electrode or piezo from t = 0 to the hold level, with the name of each searched parameter at the
/// times where it acts. Empty without searched parameters.
[[nodiscard]] std::string parameter_drawing(const ClosingRecord& result, const std::string& drive);

}  // namespace softland::internal
