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

/// Claims the places that --json and --out name, for the run's output alone. Call it after reading the scene and before any
/// long computation. The folder, if given, will hold `files`; the `kept` ones are those of an earlier run that this one
/// continues. Throws InvalidInput where one cannot be written to, or would replace an input of this run or another of its
/// outputs.
[[nodiscard]] std::optional<ResultFolder> claim_places(const Common& common, const std::vector<std::string>& files,
                                                       const std::vector<std::string>& kept = {});

/// Returns "In FOLDER: these files".
[[nodiscard]] std::string left_in(const std::filesystem::path& folder, const std::vector<std::string>& files);

/// Prints data as --json asks for, or else `text` on standard output.
void print_json_or(const Common& common, const nlohmann::json& data, const std::string& text);

/// Returns the exit status of a verb.
[[nodiscard]] int exit_status_of(verbs::Ending ending);

}  // namespace softland::apps
