// The moving part of a switch during a closing, as a picture that the script of a page animates.
#pragma once

#include <string>

#include "reports/closing_record.h"

namespace softland::internal {

/// Draws the switch from the side with its contacts at a time that the reader chooses or plays; in print and without a script,
/// the figure shows the shapes at a few instants. Empty if the motion is unknown. The colours come from the CSS of the page.
[[nodiscard]] std::string motion_figure(const ClosingRecord& result);

}  // namespace softland::internal
