// A scene for Python, and the results of studies of the scene.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/scene.h"
#include "python/run.h"
#include "studies/closing/prepared.h"
#include "verbs/simulate.h"

namespace softland::python {

/// A scene file, and the scene prepared for simulation, which is reused until the scene file changes.
struct PyScene {
  SceneFile file;
  std::filesystem::path directory;  ///< folder to which relative paths in the scene refer
  /// The prepared scene without and with the default voltage limits of a search; null until requested.
  std::shared_ptr<const PreparedScene> plain = {}, limited = {};

  /// Returns the scene prepared for simulation; the first call prepares it. With `default_limits`, electrodes and piezos
  /// without voltage limits in the scene get those of a search.
  [[nodiscard]] std::shared_ptr<const PreparedScene> ready(bool default_limits, InterruptibleRun& run);
  [[nodiscard]] std::shared_ptr<const PreparedScene> ready(bool default_limits = false) {
    InterruptibleRun run;
    return ready(default_limits, run);
  }
};

/// The result of a verb of verbs/study.h: its JSON and its files, each of which is made when it is requested.
struct Outcome {
  std::string json;
  std::map<std::string, std::function<std::string()>> files = {};
  std::string text = {};
  std::vector<std::string> notes = {};
};

[[nodiscard]] Outcome python_outcome(const nlohmann::json& data, const std::vector<verbs::Outcome::File>& files);

/// A simulated closing, with its scene and its motion.
struct PyClosing : verbs::Simulated {
  std::string command;
};

void bind_scene(pybind11::module_& module);
void bind_waveforms(pybind11::module_& module);
void bind_evaluator(pybind11::module_& module);
void bind_search(pybind11::module_& module);
void bind_exploration(pybind11::module_& module);
void bind_tuning(pybind11::module_& module);
void bind_recordings(pybind11::module_& module);

/// A waveform of any waveform family (pulse, ramp, ...), so that Python has a single type for all of them.
struct PyWaveform {
  Waveform value;
};

/// Converts a Python dict of softland._softland.Waveform, by name of the electrode, piezo or dispersion force, to waveforms
/// that replace those of a scene.
[[nodiscard]] DriveWaveforms waveforms_of(const pybind11::dict& given, InterruptibleRun& run);

/// Returns the result of `work`. Messages about an invalid request name options by their Python keywords.
template <class Work>
auto in_keywords(const char* verb, Work&& work) {
  try {
    return work();
  } catch (const InvalidRequest& error) {
    const verbs::Study& study = verbs::study_named(verb);
    throw InvalidInput(verbs::spelled(error, [&](std::string_view option) { return study.keyword(option); }));
  }
}

/// Runs a verb of verbs/study.h on a scene. `waveforms` are sets of drive waveforms to evaluate besides those of the scene: a
/// dict by name of the set, of dicts by electrode or piezo.
[[nodiscard]] Outcome study(PyScene& scene, const std::string& verb, const verbs::Arguments& arguments,
                            const pybind11::dict& waveforms, std::string command, const pybind11::object& on_progress);

/// Returns the scene with other waveforms for some electrodes, piezos or the dispersion force. Throws InvalidInput for a name
/// that the scene lacks, and for a waveform beyond the limits of its voltage source.
[[nodiscard]] std::shared_ptr<const PreparedScene> driven_by(const std::shared_ptr<const PreparedScene>& prepared,
                                                             const DriveWaveforms& waveforms);

}  // namespace softland::python
