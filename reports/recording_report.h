// The content of an instrument's file, for people and programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "exchange/recording.h"

namespace softland {

/// Returns
/// {"format","time":{"first_s","last_s","interval_s","repeated"},"channels":[{"name","unit","samples","first","last","minimum",
/// "maximum"}],"left_out":[],"notes":[]}; null where there are no times.
[[nodiscard]] nlohmann::json recording_json(const Recording& recording);

/// Returns a line about the file, and a table of its channels.
[[nodiscard]] std::string recording_text(const Recording& recording);

/// Returns a static SVG document with every channel against time. For long recordings the extremes of every short span are
/// drawn.
[[nodiscard]] std::string recording_svg(const Recording& recording);

}  // namespace softland
