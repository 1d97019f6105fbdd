// Writes and reads the JSON of results as the text of files.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace softland {

/// Returns JSON as text on one line, or with `indent` blanks per level. Bytes that are not UTF-8, as in some paths, become
/// U+FFFD.
[[nodiscard]] std::string json_text(const nlohmann::json& data, int indent = -1);

/// Returns the JSON of a result as the option --json writes it, without curves over time.
[[nodiscard]] nlohmann::json without_curves(nlohmann::json record);

/// Parses the content of a file: a JSON object that states its kind; all other members may be missing or of another type.
/// `name` stands for the file in messages. Throws InvalidInput for anything else.
[[nodiscard]] nlohmann::json parse_record(std::string_view content, const std::string& name);
/// Throws InvalidInput unless this version of softland wrote the JSON of a result.
void require_version(const nlohmann::json& record, const std::string& name);

}  // namespace softland
