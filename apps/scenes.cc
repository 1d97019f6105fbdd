#include "apps/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/values.h"
#include "base/choice.h"
#include "base/read_file.h"
#include "base/require.h"
#include "reports/result_reader.h"
#include "waveforms/export.h"

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

nlohmann::json load_result(const fs::path& path) { return parse_result(read_file(path), path.string()); }

SceneFile scene_of_result(const std::string& result) {
  fs::path path = result;
  if (is_folder(path)) {
    const auto here = [&](const char* name) {
      std::error_code ignored;
      return fs::exists(fs::path(result) / name, ignored);
    };
    require(here("best.toml") || here("result.json"), fmt::format("{}: holds neither best.toml nor result.json", result));
    path /= here("result.json") ? "result.json" : "best.toml";
  }
  if (path.extension() != ".json") return SceneFile::load(path);
  const nlohmann::json j = load_result(path);
  require(j.contains("scene_toml") && j["scene_toml"].is_string(),
          fmt::format("{}: holds no text of the scene; give the result.json in the folder that --out named", path.string()));
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
  throw InvalidInput(fmt::format("scenes/{} was not found beside the program; name a scene file", name));
}

void set_calibration(SceneFile& file, const std::string& given) {
  if (given.empty()) return;
  file.erase("calibration");
  if (given == "none") return;
  constexpr std::string_view before = " in ", after = " classes";
  const std::size_t in = given.ends_with(after) ? given.rfind(before) : std::string::npos;
  std::set<std::string> seen;
  for (const std::string& one : parts_of(given.substr(0, in))) {
    const std::size_t colon = one.find(':');
    const std::string name = one.substr(0, colon), error = colon != std::string::npos ? one.substr(colon + 1)
                                                           : name == measured_time    ? "0 s"
                                                                                      : "0 %";
    require(std::ranges::find(measurement_names, name) != measurement_names.end(), [&] {
      return fmt::format("--calibrate {}: '{}' is no measurement; there are {}, with an error such as {}:1 % or {}:50 ns",
                         shown(given), name, in_words(measurement_names), measured_pull_in, measured_time);
    });
    require(seen.insert(name).second, [&] { return fmt::format("--calibrate {}: {} stands twice", shown(given), name); });
    file.set(fmt::format("calibration.{}.error=\"{}\"", name, error));
  }
  if (in == std::string::npos) return;
  const std::size_t number = in + before.size();
  file.set("calibration.classes=" + given.substr(number, given.size() - after.size() - number));
}

std::map<std::string, Signal> named_signals(const PreparedScene& p) {
  std::map<std::string, Signal> all;
  const std::vector<std::string> names = p.drive_names();
  const std::vector<Signal> signals = p.signals();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] != dispersion_drive) all.emplace(names[k], signals[k]);
  }
  return all;
}

SentSignals sent_signals(const PreparedScene& p, const std::vector<Waveform>& waveforms, Sent sent) {
  SentSignals all;
  const std::vector<std::string> names = p.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == dispersion_drive) continue;
    const Signal told = p.told(k, waveforms[k]);
    all.signals.emplace(names[k], sent == Sent::output ? p.driven(k, told) : p.told_samples(k, told));
    if (const auto rate = p.source(k).sample_rate; rate && sent == Sent::told) all.sample_rates.emplace(names[k], *rate);
  }
  return all;
}

std::string told_csv(const PreparedScene& p) {
  const SentSignals sent = sent_signals(p, p.in_drive_order(p.drives.waveforms));
  return csv(sent.signals, p.duration, sent.sample_rates);
}

}  // namespace softland::apps
