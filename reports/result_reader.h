// Results of earlier runs, read again.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "reports/result.h"

namespace softland {

/// The JSON that the content of a file holds, which says of what kind it is: an object; everything else in it may be missing or
/// of another type. `name` stands for the file in messages. Throws InvalidInput for anything else.
[[nodiscard]] nlohmann::json parse_record(std::string_view content, const std::string& name);
/// Throws InvalidInput unless it was made by this version of softland.
void require_version(const nlohmann::json& record, const std::string& name);

/// The JSON that the content of a result.json holds: an object of kind "simulate" or "optimize"; everything else in it may be
/// missing or of another type. `name` stands for the file in messages. Throws InvalidInput for anything else.
[[nodiscard]] nlohmann::json parse_result(std::string_view content, const std::string& name);

/// Throws InvalidInput unless a report can be made of this result: it has figures and a scene.
void require_reportable(const nlohmann::json& result);

/// The result that the JSON describes. Every part of it is optional: what is missing, null or of another type is not available.
/// Throws InvalidInput when `result` is not an object.
[[nodiscard]] Result read_result(const nlohmann::json& result);

/// What a report shows of a resolved scene.
[[nodiscard]] ResultScene read_result_scene(const nlohmann::json& scene);

}  // namespace softland
