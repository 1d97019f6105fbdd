// The verbs write their results to standard output, the file of --json, and the folder of --out.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/options.h"
#include "reports/result_folder.h"
#include "verbs/study.h"

namespace softland::apps {

/// Reserves the file of --json and the folder of --out for this run; returns the folder, none without --out. Call it after
/// reading the scene and before any long computation. This run will write `files` to the folder; the files `kept` of an earlier
/// run are continued, not replaced. Throws InvalidInput if a file cannot be written, or would replace an input or another
/// output of this run.
[[nodiscard]] std::optional<ResultFolder> reserve_outputs(const Common& common, const std::vector<std::string>& files,
                                                          const std::vector<std::string>& kept = {});

/// Returns a text that lists written files: "In FOLDER: FILE, FILE".
[[nodiscard]] std::string files_written(const std::filesystem::path& folder, const std::vector<std::string>& files);

/// Writes `data` as JSON if --json is given, and prints `text` unless the JSON goes to standard output.
void print_json_or(const Common& common, const nlohmann::json& data, const std::string& text);

/// Returns the exit status for the outcome of a verb.
[[nodiscard]] int exit_status_of(verbs::Ending ending);

}  // namespace softland::apps
