#include <nlohmann/json.hpp>
#include <optional>

#include "tests/fuzz/scene_checks.h"
#include "tests/fuzz/targets.h"

namespace softland::fuzz {
namespace {

/// Returns the result of `make`, or nothing if it refuses its input.
template <class Make>
auto taken(const Make& make) {
  std::optional<decltype(make())> value;
  accepted([&] { value.emplace(make()); });
  return value;
}

SceneFile reread(const SceneFile& file) { return SceneFile::parse(file.text(), file.name(), "/nonexistent"); }

}  // namespace

void check_scene(const SceneFile& file) {
  const auto again = taken([&] { return reread(file); });
  check(again.has_value(), "a scene cannot be read again:\n" + file.text());
  check(again->text() == file.text(), "a scene changes when it is read again:\n" + file.text());
  check(again->json().dump() == file.json().dump(), "the JSON of a scene changes when it is read again:\n" + file.text());

  const auto scene = taken([&] { return read_scene(file); });
  check(scene.has_value() == taken([&] { return read_scene(*again); }).has_value(),
        "a scene is taken only once:\n" + file.text());
  if (!scene) return;
  std::map<std::string, PullInVoltages> pull_in;
  for (const std::string& drive : scene->need_pull_in) pull_in[drive] = {.static_pull_in = 20, .dynamic_pull_in = 18};
  const auto drives = taken([&] { return scene->drives(pull_in); });
  const auto whole = taken([&] { return resolved(*scene, pull_in); });
  check(drives.has_value() == whole.has_value(), "drives() and resolved() disagree:\n" + file.text());
  if (!whole) return;
  for (const auto& [name, waveform] : drives->waveforms()) static_cast<void>(signal(waveform));
  const Scene whole_scene = read_scene(reread(*whole));
  check(whole_scene.need_pull_in.empty(), "a resolved scene needs pull-in voltages:\n" + whole->text());
  check(resolved(whole_scene, {}).text() == whole->text(), "a resolved scene does not resolve to itself:\n" + whole->text());
}

void scene(std::string_view input) {
  // The folder does not exist, so that no file of this machine is read as a table.
  if (const auto file = taken([&] { return SceneFile::parse(input, "fuzz.toml", "/nonexistent"); })) check_scene(*file);
}

}  // namespace softland::fuzz
