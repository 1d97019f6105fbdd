// The shipped scenes, with changes.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "base/require.h"
#include "config/scene.h"
#include "objectives/cost.h"

namespace softland {

inline SceneFile scene(const char* name, std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/" + name);
  for (const std::string_view change : changes) file.set(change);
  return file;
}

/// Returns the file names of all shipped scenes.
inline std::vector<std::string> shipped_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(SOFTLAND_SOURCE_DIR) + "/scenes"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().filename().string());
  return names;
}

inline SceneFile gold(std::initializer_list<std::string_view> changes = {}) { return scene("mem-gold.toml", changes); }
inline SceneFile gold_pzt(std::initializer_list<std::string_view> changes = {}) { return scene("mem-gold-pzt.toml", changes); }

inline SceneFile gold_with_two_modes() { return gold({"structure.modes=2"}); }

/// Returns a beam or a plate that moves in one mode without losses.
inline SceneFile undamped_with_one_mode(const std::string& name) {
  SceneFile file = scene(name.c_str());
  for (const char* lossy : {"gas", "structure.damping_ratio"}) file.erase(lossy);
  if (name == "mem-gold.toml") file.set("structure.modes=1");
  return file;
}

/// Returns the gold cantilever under the plain step of the thesis in a window of 100 us.
inline SceneFile gold_at_17_volts(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = gold(
      {"waveform.main.level=17.771 V", "driver.main.max_voltage=25 V", "simulate.duration=100 us", "simulate.accuracy=1e-4"});
  for (const std::string_view change : changes) file.set(change);
  return file;
}

/// All targets of searches.
inline const std::vector<Target> every_target = [] {
  std::vector<Target> all;
  for (const TargetRow& row : targets) all.push_back(row.value);
  return all;
}();

/// Returns a scene with the keys that a search for this target needs.
inline SceneFile with_keys_for(Target target, SceneFile file) {
  if (target == Target::electrical) file.set("metrics.closed_force=0.1 uN");
  return file;
}

/// Returns a rigid plate on a spring without gas: one degree of freedom.
inline SceneFile spring_plate(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = SceneFile::parse(R"(
[structure]
kind = "plate"
area = "1e-8 m^2"
mass = "2.4e-9 kg"
stiffness = "42 N/m"
[gap]
electrode = "3.8 um"
contact = "2.6 um"
[electrode.main]
fringing = "none"
[contact]
model = "linear"
stiffness = "1e5 N/m"
[waveform.main]
family = "step"
level = "100 V"
[driver.main]
min_voltage = "0 V"
max_voltage = "120 V"
[simulate]
duration = "300 us"
accuracy = 1e-6
)",
                                    "plate.toml");
  for (const std::string_view change : changes) file.set(change);
  return file;
}

/// Returns the scene without one of its sections.
inline SceneFile without(const SceneFile& file, std::string_view section) {
  std::string text = file.text();
  const std::size_t begin = text.find("[" + std::string(section) + "]");
  if (begin == std::string::npos) throw InvalidInput("no such section in the test's scene");
  const std::size_t end = text.find("\n[", begin);
  text.erase(begin, end == std::string::npos ? end : end + 1 - begin);
  return SceneFile::parse(text, "changed.toml");
}

/// Returns the message with which `action` refuses its input; empty if it accepts it.
template <class Action>
std::string refusal(Action&& action) {
  try {
    action();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}

}  // namespace softland
