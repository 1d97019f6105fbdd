#include "python/scene.h"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>

#include "config/units.h"
#include "model/mode_shapes.h"
#include "model/recorded_motion.h"
#include "python/array.h"
#include "reports/closing_record.h"
#include "reports/record_file.h"
#include "studies/closing/auto_settings.h"
#include "verbs/report_outcome.h"
#include "waveforms/export.h"

namespace softland::python {

namespace py = pybind11;

std::shared_ptr<const PreparedScene> PyScene::ready(bool default_limits, InterruptibleRun& run) {
  std::shared_ptr<const PreparedScene>& kept = default_limits ? limited : plain;
  if (!kept) {
    const SceneFile copy = file;  // another Python thread may change `file` while this thread prepares the scene
    kept = run([&](const Progress& progress) {
      return std::make_shared<const PreparedScene>(prepare_and_choose(copy, default_limits, progress));
    });
  }
  return kept;
}

std::shared_ptr<const PreparedScene> driven_by(const std::shared_ptr<const PreparedScene>& prepared,
                                               const DriveWaveforms& waveforms) {
  if (waveforms.empty()) return prepared;
  auto own = std::make_shared<PreparedScene>(*prepared);
  for (const auto& [drive, waveform] : waveforms) {
    require(own->drives.find(drive) != nullptr, [&] { return fmt::format("waveforms: unknown drive '{}'", drive); });
    Drive& driven = own->drives.at(drive);
    if (driven.limits) {
      const Signal commanded = own->commanded(own->drives.place(drive), waveform);
      // Largest error [V] of the polynomials that approximate a Python function of the voltage: the limits are widened by it.
      const double missed = std::holds_alternative<Own>(waveform) ? own_waveform_accuracy * commanded.peak() : 0;
      const std::string why = violation(commanded, {.min_voltage = driven.limits->min_voltage - missed,
                                                    .max_voltage = driven.limits->max_voltage + missed,
                                                    .max_slew = driven.limits->max_slew});
      require(why.empty(), [&] { return fmt::format("waveforms: {}: {}", drive, why); });
    }
    driven.waveform = waveform;
  }
  return own;
}

namespace {

using Value = std::variant<bool, int, double, std::string>;

// Sets the value of a scene key as the option --set does; a number is in the SI unit of the key.
void change(SceneFile& file, const std::string& key, const Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return file.set(key + "=" + *text);
  try {
    if (const auto* flag = std::get_if<bool>(&value)) return file.assign(key, SceneValue(*flag));
    if (const auto* whole = std::get_if<int>(&value)) return file.assign(key, SceneValue(*whole));
    file.assign(key, SceneValue(std::get<double>(value)));
  } catch (const std::logic_error&) {  // leave the invalid key as it is: read_scene() reports it
    file.set(key + "=" +
             std::visit(
                 []<class T>(const T& one) {
                   if constexpr (std::is_same_v<T, bool>)
                     return std::string(one ? "true" : "false");
                   else if constexpr (std::is_same_v<T, std::string>)
                     return one;
                   else
                     return fmt::format("{}", one);
                 },
                 value));
  }
}

std::string json_of_scene(const SceneFile& file) { return json_text(file.json()); }

// Returns time, deflection, velocity, acceleration and contact force of a simulated motion, with a row for each knot (a point
// between two steps of the integrator).
py::array_t<double> points_of(const Trajectory& run) {
  py::array_t<double> all({static_cast<py::ssize_t>(run.points.size()), py::ssize_t{5}});
  auto to = all.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < to.shape(0); ++i) {
    const TrajectoryPoint& p = run.points[static_cast<std::size_t>(i)];
    to(i, 0) = p.time, to(i, 1) = p.position, to(i, 2) = p.velocity, to(i, 3) = p.acceleration, to(i, 4) = p.contact_force;
  }
  return all;
}

py::array_t<double> rebounds_of(const std::vector<Rebound>& rebounds) {
  py::array_t<double> all({static_cast<py::ssize_t>(rebounds.size()), py::ssize_t{3}});
  auto to = all.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < to.shape(0); ++i) {
    const Rebound& r = rebounds[static_cast<std::size_t>(i)];
    to(i, 0) = r.begin, to(i, 1) = r.end, to(i, 2) = r.height;
  }
  return all;
}

// The motion of a closing in all modes. The closing has stored only its contact point, so it is simulated again.
struct Motion {
  RecordedMotion tape;
  std::size_t modes = 0;
};
Motion motion_of(const PyClosing& c, const Progress& progress) {
  const Switch model(c.prepared->scene.device, c.closing.quadrature);
  const std::vector<Signal> signals = c.prepared->signals();
  const Hold hold = hold_of(model, signals);
  Motion motion{.modes = static_cast<std::size_t>(model.modes())};
  const Trajectory end = observe_closing(model, signals,
                                         {.duration = c.prepared->duration,
                                          .tolerance = c.closing.tolerance,
                                          .steady_force = hold.steady_force(c.prepared->scene.metrics),
                                          .start = c.prepared->start(),
                                          .stop = progress.stop},
                                         motion.tape);
  progress.throw_if_stopped();
  return motion;
}

// Returns the modal motion at the beginning and end of each integrator step: times (steps x 2), and coordinates, velocities and
// accelerations of the modes (steps x 2 x 3 x modes).
py::tuple arrays_of(const Motion& motion) {
  const auto steps = static_cast<py::ssize_t>(motion.tape.arcs().size()), modes = static_cast<py::ssize_t>(motion.modes);
  py::array_t<double> times({steps, py::ssize_t{2}}), states({steps, py::ssize_t{2}, py::ssize_t{3}, modes});
  double* t = times.mutable_data();
  double* x = states.mutable_data();
  for (std::size_t k = 0; k < motion.tape.arcs().size(); ++k) {
    for (const RecordedMotion::Motion& side : {motion.tape.begin(k), motion.tape.end(k)}) {
      *t++ = side.time;
      for (const double* part : {side.q, side.v, side.accelerations}) x = std::copy_n(part, motion.modes, x);
    }
  }
  return py::make_tuple(times, states);
}

py::tuple shapes_of(const PreparedScene& p, int places) {
  const ModeShapes all = mode_shapes(p.model, places);
  return py::make_tuple(all.places, all.shapes);
}

ClosingRecord record_of(const PyClosing& c) { return softland::record_of(*c.prepared, c.closing, c.command); }

// Returns a dict of (value, error, unit) by figure of merit, in the order of the table of figures. A figure that is yes or no
// has neither error nor unit.
py::dict figures_of(const Closing& closing) {
  py::dict all;
  for (const Figure& figure : asked_among(all_figures, closing.metrics.asked)) {
    const double value = figure.value(closing.metrics);
    all[py::str(std::string(figure.quantity()))] =
        figure.is_yes_or_no() ? py::object(py::bool_(value == 1))
                              : py::object(py::make_tuple(value, closing.errors[figure], std::string(figure.unit)));
  }
  return all;
}

PyClosing simulate(PyScene& scene, const verbs::Arguments& arguments, const py::dict& waveforms, std::string command,
                   const py::object& on_progress) {
  return in_keywords("simulate", [&] {
    const verbs::SimulateRequest request = verbs::simulate_request(arguments);
    InterruptibleRun run(on_progress);
    const auto prepared = driven_by(scene.ready(false, run), waveforms_of(waveforms, run));
    return run([&](const Progress& progress) {
      PyClosing found{{verbs::simulated(prepared, request, progress)}, std::move(command)};
      progress.throw_if_stopped();
      return found;
    });
  });
}

}  // namespace

void bind_scene(py::module_& m) {
  py::class_<Outcome>(m, "Outcome")
      .def_readonly("json", &Outcome::json)
      .def_readonly("text", &Outcome::text)
      .def_readonly("notes", &Outcome::notes)
      .def_property_readonly("files",
                             [](const Outcome& o) {
                               std::vector<std::string> names;
                               for (const auto& [name, ignored] : o.files) names.push_back(name);
                               return names;
                             })
      .def("file", [](const Outcome& o, const std::string& name) { return py::bytes(o.files.at(name)()); });
  py::class_<PyClosing>(m, "Closing")
      .def_property_readonly("status", [](const PyClosing& c) { return std::string(to_string(c.closing.metrics.status)); })
      .def_property_readonly("message", [](const PyClosing& c) { return c.closing.trajectory.message; })
      .def_property_readonly("warnings", [](const PyClosing& c) { return c.closing.warnings; })
      .def_property_readonly("figures", [](const PyClosing& c) { return figures_of(c.closing); })
      .def_property_readonly("duration", [](const PyClosing& c) { return c.prepared->duration; })
      .def_property_readonly("contact_gap", [](const PyClosing& c) { return c.prepared->scene.device.gap.contact; })
      .def_property_readonly("points", [](const PyClosing& c) { return points_of(c.closing.trajectory); })
      .def_property_readonly("rebounds", [](const PyClosing& c) { return rebounds_of(c.closing.rebounds); })
      .def_property_readonly("json", [](const PyClosing& c) { return json_text(json_of(record_of(c))); })
      .def_property_readonly("drives", [](const PyClosing& c) { return c.prepared->drive_names(); })
      .def("voltage",
           [](const PyClosing& c, const std::string& drive, const std::vector<double>& times) {
             const std::vector<std::string> names = c.prepared->drive_names();
             const auto found = std::find(names.begin(), names.end(), drive);
             require(found != names.end(), [&] { return fmt::format("unknown drive '{}'", drive); });
             const Signal signal = c.prepared->signals()[static_cast<std::size_t>(found - names.begin())];
             std::vector<double> volts;
             for (const double t : times) volts.push_back(signal.voltage(t));
             return array(volts);
           })
      .def("motion",
           [](const PyClosing& c) {
             InterruptibleRun run;
             return arrays_of(run([&](const Progress& progress) { return motion_of(c, progress); }));
           })
      .def("shapes", [](const PyClosing& c, int places) { return shapes_of(*c.prepared, places); })
      .def("outcome", [](const PyClosing& c) {
        const auto result = std::make_shared<const ClosingRecord>(record_of(c));
        return python_outcome(json_of(*result), verbs::files_of_report(result));
      });
  py::class_<PyScene>(m, "Scene")
      .def_static("load",
                  [](const std::filesystem::path& path) {
                    return PyScene{.file = SceneFile::load(path), .directory = path.parent_path()};
                  })
      .def_static("parse",
                  [](const std::string& text, const std::string& name, const std::filesystem::path& directory) {
                    return PyScene{.file = SceneFile::parse(text, name, directory), .directory = directory};
                  })
      .def("copy", [](const PyScene& s) { return PyScene(s); })
      .def("change",  // changes all given keys, or none after an error
           [](PyScene& s, const std::vector<std::pair<std::string, Value>>& changes) {
             SceneFile changed = s.file;
             for (const auto& [key, value] : changes) change(changed, key, value);
             static_cast<void>(read_scene(changed));
             s.file = std::move(changed), s.plain.reset(), s.limited.reset();
           })
      .def("set_waveform",
           [](PyScene& s, const std::string& drive, const PyWaveform& waveform) {
             SceneFile changed = s.file;
             changed.set_waveform(drive, waveform.value);
             static_cast<void>(read_scene(changed));
             s.file = std::move(changed), s.plain.reset(), s.limited.reset();
           })
      .def("erase",
           [](PyScene& s, const std::string& key) {
             SceneFile changed = s.file;
             changed.erase(key);
             static_cast<void>(read_scene(changed));
             s.file = std::move(changed), s.plain.reset(), s.limited.reset();
           })
      .def("check", [](const PyScene& s) { static_cast<void>(read_scene(s.file)); })
      .def("written", [](const PyScene& s, const std::string& key) { return s.file.written(key); })
      .def_property_readonly("text", [](const PyScene& s) { return s.file.text(); })
      .def_property_readonly("json", [](const PyScene& s) { return json_of_scene(s.file); })
      .def_property_readonly("name", [](const PyScene& s) { return s.file.name(); })
      .def_property_readonly("directory", [](const PyScene& s) { return s.directory; })
      .def("resolved",
           [](PyScene& s) {
             const auto p = s.ready();
             return PyScene{.file = p->resolved(), .directory = s.directory};
           })
      .def("warnings", [](PyScene& s) { return s.ready()->scene.warnings; })
      .def("drives", [](PyScene& s) { return s.ready()->drive_names(); })
      .def("waveforms",
           [](PyScene& s) {
             std::map<std::string, PyWaveform> all;
             for (const auto& [drive, waveform] : s.ready()->drives.waveforms()) all.emplace(drive, PyWaveform{waveform});
             return all;
           })
      .def("duration", [](PyScene& s) { return s.ready()->duration; })
      .def("frequencies", [](PyScene& s) { return Eigen::VectorXd(s.ready()->model.basis().angular_frequencies()); })
      .def("shapes", [](PyScene& s, int places) { return shapes_of(*s.ready(), places); })
      .def("simulate", &simulate)
      .def("study", &study);
}

}  // namespace softland::python
