// Tunings of a waveform on a device for Python: the shots (voltages for one closing each) of a tuning, and a simulated device
// that answers them.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/require.h"
#include "python/scene.h"
#include "reports/record_file.h"
#include "reports/tuning_lines.h"
#include "reports/tuning_session.h"
#include "verbs/device.h"
#include "verbs/tune.h"

namespace softland::python {

namespace py = pybind11;

namespace {

// A tuning session (closings of a real device that improve its waveform) with its scene and its request.
struct PyTuning {
  TuningSession session;
  std::string command;
};

std::unique_ptr<PyTuning> made_tuning(const PyScene& scene, const verbs::Arguments& arguments, const std::string& log,
                                      std::string command, const py::object& on_progress) {
  const verbs::TuneRequest request = in_keywords("tune", [&] { return verbs::tune_request(arguments); });
  auto tuning = std::make_unique<PyTuning>(PyTuning{.session = request.session(scene.file), .command = std::move(command)});
  if (!log.empty()) static_cast<void>(tuning->session.keep(log, request.resume));
  InterruptibleRun run(on_progress);
  run([&](const Progress& progress) {
    tuning->session.begin(progress);
    while (tuning->session.learn_kept(progress)) {
    }
    return true;
  });
  return tuning;
}

// Returns (number, duration of the hold [s], (times, volts) by name of the electrode or piezo, line of text for a laboratory
// command) of a shot, the voltages for one closing.
py::tuple shot_of(const PyTuning& tuning) {
  const CommandedShot shot = tuning.session.commanded();
  py::dict drives;
  for (const auto& [name, table] : shot.drives) drives[py::str(name)] = PyWaveform{table};
  return py::make_tuple(shot.number, shot.hold_time, shot.duration(), drives, json_text(shot_json(shot)));
}

void learn(PyTuning& tuning, const std::string& answer, const py::object& on_progress) {
  const ContactRecord record =
      read_record(read_line(answer), tuning.session.commanded().number, tuning.session.commanded().duration());
  InterruptibleRun run(on_progress);
  run([&](const Progress& progress) {
    tuning.session.learn(record, progress);
    return true;
  });
}

Outcome outcome_of(const PyTuning& tuning, const std::string& name) {
  const auto* const end = find_named(tuning_ends, name);
  require(end != nullptr, "the end of a tuning must be " + listed(tuning_ends) + ", not " + name);
  const auto files = std::make_shared<const std::map<std::string, std::string>>(tuning.session.files(end->value, tuning.command));
  Outcome outcome{.json = json_text(json_of(tuning.session.report(end->value, tuning.command)))};
  for (const auto& [file, ignored] : *files) outcome.files[file] = [files, file = file] { return files->at(file); };
  return outcome;
}

std::unique_ptr<PracticeDevice> practice(const PyScene& scene, const verbs::Arguments& arguments, const py::object& on_progress) {
  const SceneFile file = scene.file;
  const PracticeOptions options = in_keywords("device", [&] { return verbs::device_request(arguments).options(file); });
  InterruptibleRun run(on_progress);
  return run([&](const Progress&) { return std::make_unique<PracticeDevice>(file, options); });
}

// Closes a simulated device under the voltages of a shot, one JSON line. Returns the contact record as a JSON line, as the
// command `softland device` does.
std::string answered(const PracticeDevice& device, const std::string& line) {
  const CommandedShot shot = read_shot(read_line(line));
  const std::vector<Waveform> waveforms = shot.waveforms(device.nominal());
  InterruptibleRun run;
  return run([&](const Progress&) {
    return json_text(
        record_json(shot.number, device.close(static_cast<std::uint64_t>(shot.number), waveforms, shot.duration()).record));
  });
}

}  // namespace

void bind_tuning(py::module_& m) {
  py::class_<PyTuning>(m, "Tuning")
      .def(py::init(&made_tuning))
      .def("shot", &shot_of)
      .def("learn", &learn)
      .def_property_readonly("is_done", [](const PyTuning& t) { return t.session.tuner().is_done(); })
      .def_property_readonly("closings", [](const PyTuning& t) { return t.session.tuner().closings(); })
      .def_property_readonly("words", [](const PyTuning& t) { return closing_prose(t.session.report(TuningEnd::under_way)); })
      .def("ends",
           [](PyTuning& t, int closings) {
             const std::optional<TuningEnd> end = t.session.ends(closings);
             return end ? std::optional(std::string(name_of(tuning_ends, *end))) : std::nullopt;
           })
      .def("throw_if_failing", [](const PyTuning& t) { t.session.throw_if_failing(); })
      .def("outcome", &outcome_of);
  py::class_<PracticeDevice>(m, "PracticeDevice").def(py::init(&practice)).def("answer", &answered);
}

}  // namespace softland::python
