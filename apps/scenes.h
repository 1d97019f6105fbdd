// Verbs load scenes here: from files, from results, and those that are shipped.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/options.h"
#include "config/scene.h"

namespace softland::apps {

/// Returns the scene file with the changes of --set.
[[nodiscard]] SceneFile load_scene(const Common& common);

/// Returns the scene of a result: a folder that --out named, a result.json, or a scene file itself. The newest file of a folder
/// is its result.json, whichever verb left it; a search that is not done has only its best.toml.
[[nodiscard]] SceneFile scene_of_result(const std::string& result);

/// Does the same with the changes of --set.
[[nodiscard]] SceneFile load_scene_or_result(const Common& common);

/// Returns the path of the shipped scene: installed with the program, in the tree it was built from, or in an unpacked tree
/// around it.
[[nodiscard]] std::filesystem::path shipped_scene(const std::string& name);

[[nodiscard]] nlohmann::json load_result(const std::filesystem::path& path);
[[nodiscard]] bool is_folder(const std::filesystem::path& path);

}  // namespace softland::apps
