#include "tests/config/small_scene.h"
#include "tests/fuzz/scene_checks.h"
#include "tests/fuzz/targets.h"

namespace softland::fuzz {

void set(std::string_view input) {
  SceneFile file = SceneFile::parse(small_scene, "fuzz.toml", "/nonexistent");
  while (true) {
    const std::size_t end = input.find('\0');
    if (!accepted([&] { file.set(input.substr(0, end)); })) return;  // stop here as the program does
    if (end == std::string_view::npos) break;
    input.remove_prefix(end + 1);
  }
  check_scene(file);
}

}  // namespace softland::fuzz
