// Loads scenes from scene files, from results, and from the scenes shipped with the program.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/options.h"
#include "config/scene.h"

namespace softland::apps {

/// Returns the scene of the file that the command line names, with the changes of --set.
[[nodiscard]] SceneFile load_scene(const Common& common);

/// Returns the scene of a result: a folder of --out, a result.json, or a scene file. From a folder, the first existing one of
/// result.json, best.toml and release.toml is read; an unfinished search has only best.toml.
[[nodiscard]] SceneFile scene_of_result(const std::string& result);

/// Returns the scene of a scene file or of a result (scene_of_result()), with the changes of --set.
[[nodiscard]] SceneFile load_scene_or_result(const Common& common);

/// Returns the path of a shipped scene: among the installed files, in the source tree of the build, or in an unpacked source
/// tree around the program.
[[nodiscard]] std::filesystem::path shipped_scene(const std::string& name);

[[nodiscard]] nlohmann::json load_result(const std::filesystem::path& path);
[[nodiscard]] bool is_folder(const std::filesystem::path& path);

}  // namespace softland::apps
