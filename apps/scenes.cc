#include "apps/scenes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "base/read_file.h"
#include "base/require.h"
#include "reports/closing_record.h"

namespace softland::apps {

namespace fs = std::filesystem;

SceneFile load_scene(const Common& c) {
  SceneFile file = SceneFile::load(c.scene);
  for (const std::string& assignment : c.set) file.set(assignment);
  return file;
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

nlohmann::json load_result(const fs::path& path) { return parse_closing(read_file(path), path.string()); }

SceneFile scene_of_result(const std::string& result) {
  fs::path path = result;
  if (is_folder(path)) {
    constexpr std::array names{"result.json", "best.toml", "release.toml"};
    const auto* const found = std::ranges::find_if(names, [&](const char* name) {
      std::error_code ignored;
      return fs::exists(path / name, ignored);
    });
    require(found != names.end(), fmt::format("{}: is a folder without {}; give a scene file, such as {}, or the folder of --out",
                                              result, in_words(names, " or "), (path / "NAME.toml").string()));
    path /= *found;
  }
  if (path.extension() != ".json") return SceneFile::load(path);
  const nlohmann::json j = load_result(path);
  require(j.contains("scene_toml") && j["scene_toml"].is_string(),
          fmt::format("{}: does not hold the scene; name the result.json in the folder of --out", path.string()));
  return SceneFile::parse(j["scene_toml"].get<std::string>(), path.string());
}

SceneFile load_scene_or_result(const Common& c) {
  SceneFile file = scene_of_result(c.scene);
  for (const std::string& assignment : c.set) file.set(assignment);
  return file;
}

fs::path shipped_scene(const std::string& name) {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& folder : {here / SOFTLAND_INSTALLED_SCENES, fs::path(SOFTLAND_SCENES)}) {
    if (fs::exists(folder / name, error)) return (folder / name).lexically_normal();
  }
  for (fs::path up = here; up.has_relative_path(); up = up.parent_path()) {
    if (fs::exists(up / "scenes" / name, error)) return up / "scenes" / name;
  }
  throw InvalidInput(fmt::format("scenes/{} was not found with the program; name a scene file", name));
}

}  // namespace softland::apps
