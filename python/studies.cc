// Runs the verbs of verbs/study.h for Python. The build generates the Python methods from the descriptions of the verbs.
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "python/scene.h"
#include "reports/record_file.h"
#include "studies/closing/auto_settings.h"
#include "verbs/study.h"

namespace softland::python {

namespace py = pybind11;

namespace {

// Converts sets of drive waveforms, which a verb evaluates besides those of the scene, from a Python dict by name of the set.
std::map<std::string, DriveWaveforms> others_of(const py::dict& given, InterruptibleRun& run) {
  std::map<std::string, DriveWaveforms> others;
  for (const auto& [name, waveforms] : given)
    others.emplace(name.cast<std::string>(), waveforms_of(waveforms.cast<py::dict>(), run));
  return others;
}

}  // namespace

Outcome python_outcome(const nlohmann::json& data, const std::vector<verbs::Outcome::File>& files) {
  Outcome outcome{.json = json_text(data)};
  for (const verbs::Outcome::File& one : files) outcome.files[one.name] = one.text;
  return outcome;
}

Outcome study(PyScene& scene, const std::string& verb, const verbs::Arguments& arguments, const py::dict& waveforms,
              std::string command, const py::object& on_progress) {
  const verbs::Study& asked = verbs::study_named(verb);
  const auto ask = in_keywords(verb.c_str(), [&] { return asked.ask(arguments); });
  std::vector<std::string> notes;
  const auto note = [&](const std::string& line) {
    notes.push_back(verbs::spelled(line, [&](std::string_view option) { return asked.keyword(option); }));
  };
  InterruptibleRun run(on_progress);
  const std::map<std::string, DriveWaveforms> others = others_of(waveforms, run);
  const SceneFile file = scene.file;  // another Python thread may change the scene meanwhile
  std::shared_ptr<const PreparedScene> plain = scene.plain, limited = scene.limited;
  const auto outcome = in_keywords(verb.c_str(), [&] {
    return run([&](const Progress& progress) {
      const auto prepared = [&](bool default_limits) {
        std::shared_ptr<const PreparedScene>& kept = default_limits ? limited : plain;
        if (!kept) kept = std::make_shared<const PreparedScene>(prepare_and_choose(file, default_limits, progress));
        return kept;
      };
      const auto driven = [&](const std::string& name, const PreparedScene& nominal) {
        const std::shared_ptr<const PreparedScene> alias(std::shared_ptr<const PreparedScene>(), &nominal);
        DriveWaveforms all_drives = nominal.drives.waveforms();
        for (auto& [drive, waveform] : driven_by(alias, others.at(name))->drives.waveforms()) all_drives[drive] = waveform;
        return all_drives;
      };
      verbs::Outcome all_of_it = ask({.scene = file,
                                      .name = file.name(),
                                      .command = command,
                                      .progress = progress,
                                      .prepared = prepared,
                                      .load = [](const std::string& path) { return SceneFile::load(path); },
                                      .waveforms_of = driven,
                                      .text = [&] { return file.text(); },
                                      .note = note});
      progress.throw_if_stopped();
      return all_of_it;
    });
  });
  scene.plain = plain, scene.limited = limited;
  Outcome result = python_outcome(outcome.json, outcome.files);
  result.text = outcome.text, result.notes = std::move(notes);
  return result;
}

}  // namespace softland::python
