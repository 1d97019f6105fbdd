// The scenes that verbs work on: of files, of results, and those that are shipped.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/options.h"
#include "config/scene.h"
#include "studies/prepared.h"
#include "waveforms/signal.h"

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

/// "Vdp,frequency:0.5 %", and " in 8 classes" where devices are sorted: puts it in the place of what the scene says.
void set_calibration(SceneFile& file, const std::string& given);

/// Voltages of the scene as its sources give them: the factor of the dispersion force is none.
[[nodiscard]] std::map<std::string, Signal> named_signals(const PreparedScene& prepared);

/// What goes to generators and simulators of circuits: what sources are told, of those that take samples these, or what they
/// make of it.
enum class Sent { told, output };
struct SentSignals {
  std::map<std::string, Signal> signals;
  std::map<std::string, double> sample_rates = {};  ///< of those that are samples [Hz]
};
/// Of one waveform per drive in the order of Switch::drives().
[[nodiscard]] SentSignals sent_signals(const PreparedScene& prepared, const std::vector<Waveform>& waveforms,
                                       Sent sent = Sent::told);
/// What the sources of the scene are told, as CSV: read back under the same drivers it gives the same closing.
[[nodiscard]] std::string told_csv(const PreparedScene& prepared);

}  // namespace softland::apps
