// The verbs write their findings to standard output, the file of --json, and the folder of --out.
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

/// Reserves the file of --json and the folder of --out for the output of this run. Call it after reading the scene and before
/// any long computation. The folder, if given, will hold `files`; `kept` are the files of an earlier run that this run
/// continues. Throws InvalidInput if a file cannot be written, or would replace an input or another output of this run.
[[nodiscard]] std::optional<ResultFolder> reserve_outputs(const Common& common, const std::vector<std::string>& files,
                                                          const std::vector<std::string>& kept = {});

/// Returns the text "In FOLDER: FILE, FILE".
[[nodiscard]] std::string files_written(const std::filesystem::path& folder, const std::vector<std::string>& files);

/// Writes `data` as JSON where --json is given, and prints `text` unless the JSON goes to standard output.
void print_json_or(const Common& common, const nlohmann::json& data, const std::string& text);

/// Returns the exit status of a verb.
[[nodiscard]] int exit_status_of(verbs::Ending ending);

}  // namespace softland::apps
