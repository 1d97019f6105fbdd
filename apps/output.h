// Where the verbs put what they found: standard output, the file of --json, the folder of --out.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/verbs.h"

namespace softland::apps {

/// The folder of --out. Throws InvalidInput when it cannot be created.
void make_folder(const std::string& out);

/// report.html and gap.svg.
void write_report(const std::filesystem::path& folder, const nlohmann::json& result);

/// Everything a result of simulate or optimize leaves behind. `left` names what stands in the folder already.
void write_outputs(const Common& common, const nlohmann::json& result, std::vector<std::string> left = {});

/// Data as --json asks for, or else `text` on standard output.
void print_json_or(const Common& common, const nlohmann::json& data, const std::string& text);

}  // namespace softland::apps
