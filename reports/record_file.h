// Records of studies as the text of files.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace softland {

/// JSON on one line, or with `indent` blanks per level; what is not UTF-8 (a path may not be) becomes U+FFFD.
[[nodiscard]] std::string json_text(const nlohmann::json& data, int indent = -1);

/// The record of a study as --json gives it.
[[nodiscard]] nlohmann::json without_curves(nlohmann::json record);

/// The JSON that the content of a file holds, which says of what kind it is: an object; everything else in it may be missing or
/// of another type. `name` stands for the file in messages. Throws InvalidInput for anything else.
[[nodiscard]] nlohmann::json parse_record(std::string_view content, const std::string& name);
/// Throws InvalidInput unless it was made by this version of softland.
void require_version(const nlohmann::json& record, const std::string& name);

}  // namespace softland
