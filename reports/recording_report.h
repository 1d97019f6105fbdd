// What a file of an instrument holds, for people and programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "exchange/recording.h"

namespace softland {

/// {"format","time":{"first_s","last_s","interval_s","repeated"},"channels":[{"name","unit","samples","first","last","minimum",
/// "maximum"}],"left_out":[],"notes":[]}; null where there are no times.
[[nodiscard]] nlohmann::json recording_json(const Recording& recording);

/// A line about the file, and a table of its channels.
[[nodiscard]] std::string recording_text(const Recording& recording);

/// A static SVG document: every channel against time. Of long recordings the extremes of every short span are drawn.
[[nodiscard]] std::string recording_svg(const Recording& recording);

}  // namespace softland
