// Loads scenes from files, from results, and from the scenes shipped with the program.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/options.h"
#include "config/scene.h"

namespace softland::apps {

/// Returns the scene file with the changes of --set.
[[nodiscard]] SceneFile load_scene(const Common& common);

/// Returns the scene of a result: a folder of --out, a result.json, or a scene file. In a folder, the first existing one of
/// result.json, best.toml and release.toml is read; an unfinished search has only its best.toml.
[[nodiscard]] SceneFile scene_of_result(const std::string& result);

/// Returns the scene of a result, as above, with the changes of --set.
[[nodiscard]] SceneFile load_scene_or_result(const Common& common);

/// Returns the path of the shipped scene: installed with the program, in the tree it was built from, or in an unpacked tree
/// around it.
[[nodiscard]] std::filesystem::path shipped_scene(const std::string& name);

[[nodiscard]] nlohmann::json load_result(const std::filesystem::path& path);
[[nodiscard]] bool is_folder(const std::filesystem::path& path);

}  // namespace softland::apps
