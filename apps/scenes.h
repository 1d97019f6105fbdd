// The scenes that verbs work on: of files, of results, and those that are shipped.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/options.h"
#include "config/scene.h"

namespace softland::apps {

/// The scene file with what --set says.
[[nodiscard]] SceneFile load_scene(const Common& common);

/// The scene of a result: a folder that --out named, a result.json, or a scene file itself. Of what a folder holds its
/// result.json is the newest, whichever verb left it; a search that is not done has only its best.toml.
[[nodiscard]] SceneFile scene_of_result(const std::string& result);

/// The same with what --set says.
[[nodiscard]] SceneFile load_scene_or_result(const Common& common);

/// Where the shipped scene is: installed with the program, in the tree it was built from, or in an unpacked tree around it.
[[nodiscard]] std::filesystem::path shipped_scene(const std::string& name);

[[nodiscard]] nlohmann::json load_result(const std::filesystem::path& path);
[[nodiscard]] bool is_folder(const std::filesystem::path& path);

}  // namespace softland::apps
