// A scene under Python, and what the verbs make of it.
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

/// A scene file and what was made of it, which is kept until the scene changes.
struct PyScene {
  SceneFile file;
  std::filesystem::path directory;                                ///< the directory that relative paths in it start from
  std::shared_ptr<const PreparedScene> plain = {}, limited = {};  ///< prepare_and_choose() without and with default limits

  /// Made ready, when it is first asked for.
  [[nodiscard]] std::shared_ptr<const PreparedScene> ready(bool default_limits, Run& run);
  [[nodiscard]] std::shared_ptr<const PreparedScene> ready(bool default_limits = false) {
    Run run;
    return ready(default_limits, run);
  }
};

/// The result of a verb: its JSON, and the files that the program writes of it, each made when it is asked for.
struct Outcome {
  std::string json;
  std::map<std::string, std::function<std::string()>> files = {};
  std::string text = {};
  std::vector<std::string> notes = {};
};

[[nodiscard]] Outcome python_outcome(const nlohmann::json& data, const std::vector<verbs::Outcome::File>& files);

/// One closing, with what it is of.
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

/// A waveform, wrapped so that it is one Python type whatever its family.
struct PyWaveform {
  Waveform value;
};

/// The waveforms that replace those of a scene, by drive.
/// Takes a Python dict of softland._softland.Waveform.
[[nodiscard]] DriveWaveforms waveforms_of(const pybind11::dict& given, Run& run);

/// Returns the result of `work`. Messages about a request have its options in the words of Python.
template <class Work>
auto in_keywords(const char* verb, Work&& work) {
  try {
    return work();
  } catch (const InvalidRequest& error) {
    const verbs::Study& study = verbs::study_named(verb);
    throw InvalidInput(verbs::spelled(error, [&](std::string_view option) { return study.keyword(option); }));
  }
}

/// Asks a study (verbs/study.h) of a scene. `waveforms` are those of others, by name and drive.
[[nodiscard]] Outcome study(PyScene& scene, const std::string& verb, const verbs::Told& told, const pybind11::dict& waveforms,
                            std::string command, const pybind11::object& progress);

/// A scene like this one under other waveforms. Throws InvalidInput for a drive that it has not, and beyond its limits.
[[nodiscard]] std::shared_ptr<const PreparedScene> driven_by(const std::shared_ptr<const PreparedScene>& prepared,
                                                             const DriveWaveforms& waveforms);

}  // namespace softland::python
