// Tunings under Python: the shots of a session, and a simulated device that answers them.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "config/criterion.h"
#include "python/scene.h"
#include "reports/result_json.h"
#include "reports/tuning_lines.h"
#include "reports/tuning_session.h"
#include "studies/tuning/practice_device.h"

namespace softland::python {

namespace py = pybind11;

namespace {

// A simulated laboratory has a trigger delay of its own, and expects none.
enum class Laboratory { expected, simulated };

LaboratoryErrors errors_of(const SceneFile& file, const py::dict& given, Laboratory which) {
  LaboratoryErrors errors = usual_errors(file);
  const auto take = [&](double& value, const char* name) {
    const auto told = given[name].cast<std::optional<double>>();
    if (!told) return;
    require(*told >= 0, [&] { return fmt::format("{}: must be at least 0", name); });
    value = *told;
  };
  take(errors.edge_error, "edge_error");
  take(errors.unseen, "unseen");
  take(errors.gain_error, "gain_error");
  take(errors.shot_error, "shot_error");
  if (which == Laboratory::expected) take(errors.trigger_delay, "trigger_delay");
  return errors;
}

// A session and what it was begun by.
struct PyTuning {
  TuningSession session;
  std::string command;

  [[nodiscard]] Provenance provenance() const { return {.command = command}; }
};

TunerOptions options_of(const SceneFile& file, const py::dict& given) {
  const auto name = given["actuator"].cast<std::string>();
  const Named<Actuator>* actuator = find_named(actuators, name);
  require(actuator != nullptr, [&] { return fmt::format("actuator {}: must be {}", name, listed(actuators)); });
  TunerOptions options{.actuator = actuator->value,
                       .seed = given["seed"].cast<std::uint64_t>(),
                       .jobs = given["jobs"].cast<int>(),
                       .laboratory = errors_of(file, given, Laboratory::expected)};
  if (const auto touch = given["constrain"].cast<std::string>(); !touch.empty()) {
    try {
      options.touch = parse_criterion(touch, all_figures);
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("constrain: {}", error.what()));
    }
  }
  if (const auto recipes = given["recipes"].cast<std::optional<int>>()) options.most_recipes = *recipes;
  if (const auto effort = given["effort"].cast<std::optional<double>>()) options.effort = *effort;
  check(options);
  return options;
}

std::unique_ptr<PyTuning> made(const PyScene& scene, const py::dict& given, const std::string& log, bool resume,
                               const py::object& progress) {
  auto tuning = std::make_unique<PyTuning>(PyTuning{
      .session = TuningSession(scene.file, options_of(scene.file, given), given["wafer"].cast<std::vector<std::string>>()),
      .command = given["command"].cast<std::string>()});
  if (!log.empty()) static_cast<void>(tuning->session.keep(log, resume));
  Run run(progress);
  run([&](const Watch& watch) {
    tuning->session.begin(watch);
    while (tuning->session.learn_kept(watch)) {
    }
    return true;
  });
  return tuning;
}

// number, how long the last levels are held [s], (times, volts) by drive, and the line that a program is told
py::tuple shot_of(const PyTuning& tuning) {
  const ToldShot shot = tuning.session.told();
  py::dict drives;
  for (const auto& [name, table] : shot.drives) drives[py::str(name)] = PyWaveform{table};
  return py::make_tuple(shot.number, shot.hold_time, shot.duration(), drives, json_text(shot_json(shot)));
}

void learn(PyTuning& tuning, const std::string& answer, const py::object& progress) {
  const ContactRecord record = read_record(read_line(answer), tuning.session.told().number, tuning.session.told().duration());
  Run run(progress);
  run([&](const Watch& watch) {
    tuning.session.learn(record, watch);
    return true;
  });
}

Outcome outcome_of(const PyTuning& tuning, const std::string& name) {
  const TuningEnd end = tuning_end(name);
  const auto files = std::make_shared<const std::map<std::string, std::string>>(tuning.session.files(end, tuning.provenance()));
  Outcome outcome{.json = json_text(tuning.session.json(end, tuning.provenance()))};
  for (const auto& [file, ignored] : *files) outcome.files[file] = [files, file = file] { return files->at(file); };
  return outcome;
}

std::unique_ptr<PracticeDevice> practice(const PyScene& scene, const py::dict& given) {
  const SceneFile file = scene.file;
  PracticeOptions options{.seed = given["seed"].cast<std::uint64_t>(),
                          .laboratory = errors_of(file, given, Laboratory::simulated),
                          .drift = given["drift"].cast<double>(),
                          .trigger_delay = given["trigger_delay"].cast<double>(),
                          .model = {.more_modes = given["more_modes"].cast<int>(),
                                    .gas = given["gas"].cast<std::string>(),
                                    .stiffness = given["stiffness"].cast<double>(),
                                    .set = given["set"].cast<std::vector<std::string>>()}};
  require(options.model.more_modes >= 0, "more_modes: must be at least 0");
  require(options.model.stiffness > 0, "stiffness: must be above 0");
  Run run;
  return run([&](const Watch&) { return std::make_unique<PracticeDevice>(file, options); });
}

// The line that `softland device` answers to this one.
std::string answered(const PracticeDevice& device, const std::string& line) {
  const ToldShot shot = read_shot(read_line(line));
  const std::vector<Waveform> waveforms = shot.waveforms(device.nominal());
  Run run;
  return run([&](const Watch&) {
    return json_text(
        record_json(shot.number, device.close(static_cast<std::uint64_t>(shot.number), waveforms, shot.duration()).record));
  });
}

}  // namespace

void bind_tuning(py::module_& m) {
  py::class_<PyTuning>(m, "Tuning")
      .def(py::init(&made))
      .def("shot", &shot_of)
      .def("learn", &learn)
      .def_property_readonly("is_done", [](const PyTuning& t) { return t.session.tuner().is_done(); })
      .def_property_readonly("closings", [](const PyTuning& t) { return t.session.tuner().closings(); })
      .def_property_readonly("words", [](const PyTuning& t) { return closing_words(t.session.report(TuningEnd::under_way)); })
      .def("ends",
           [](PyTuning& t, int closings) {
             const std::optional<TuningEnd> end = t.session.ends(closings);
             return end ? std::optional(std::string(name_of(*end))) : std::nullopt;
           })
      .def("throw_if_failing", [](const PyTuning& t) { t.session.throw_if_failing(); })
      .def("outcome", &outcome_of);
  py::class_<PracticeDevice>(m, "PracticeDevice").def(py::init(&practice)).def("answer", &answered);
}

}  // namespace softland::python
