// The moving part of a switch in a closing, as a figure of a page that its script moves.
#pragma once

#include <string>

#include "reports/closing_record.h"

namespace softland::internal {

/// Shows the switch from the side with its contacts at a time that the reader sets, plays, or reads in the charts; in print and
/// without a script it shows the shapes at a few instants. Empty where the motion is not known. Its colours are the page's.
[[nodiscard]] std::string motion_figure(const ClosingRecord& result);

}  // namespace softland::internal
