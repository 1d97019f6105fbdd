// Describes the content of a file from an instrument, as JSON, text and picture.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "exchange/recording.h"

namespace softland {

/// Returns the content of a recording as JSON
/// {"format","time":{"first_s","last_s","interval_s","repeated"},"channels":[{"name","unit","samples","first","last","minimum",
/// "maximum"}],"left_out":[],"notes":[]}; a time that the file lacks is null.
[[nodiscard]] nlohmann::json recording_json(const Recording& recording);

/// Returns text: a line about the file of the instrument, and a table of its channels.
[[nodiscard]] std::string recording_text(const Recording& recording);

/// Returns a static SVG document with every channel against time. A long recording is drawn by the extremes of short intervals.
[[nodiscard]] std::string recording_svg(const Recording& recording);

}  // namespace softland
