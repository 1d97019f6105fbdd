// Waveforms as Python objects.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <utility>

#include "base/require.h"
#include "config/schema.h"
#include "python/own.h"
#include "python/scene.h"
#include "waveforms/export.h"

namespace softland::python {

namespace py = pybind11;

DriveWaveforms waveforms_of(const py::dict& given, InterruptibleRun&) {
  DriveWaveforms all;
  for (const auto& [drive, waveform] : given) all[drive.cast<std::string>()] = waveform.cast<const PyWaveform&>().value;
  return all;
}

namespace {

// Returns a waveform of the named waveform family with the given parameters in SI units; other parameters have the defaults of
// the family.
PyWaveform made(const std::string& name, const py::dict& parameters) {
  std::optional<Waveform> found;
  std::vector<std::string_view> families;
  for_each_family([&]<class Family>(Family one) {
    families.push_back(FamilyOf<Family>::name);
    if (FamilyOf<Family>::name != name) return;
    std::vector<std::string_view> names;
    for (const Parameter<Family>& parameter : FamilyOf<Family>::parameters) {
      names.push_back(parameter.name);
      const py::str key(std::string(parameter.name));
      if (!parameters.contains(key)) {
        require(!parameter.required, [&] { return fmt::format("{}: missing parameter '{}'", name, parameter.name); });
        continue;
      }
      const py::object value = parameters[key];
      const auto* number = std::get_if<double Family::*>(&parameter.member);
      try {
        if (number != nullptr) {
          one.** number = value.cast<double>();
        } else {
          one.*std::get<std::vector<double> Family::*>(parameter.member) = value.cast<std::vector<double>>();
        }
      } catch (const py::cast_error&) {
        throw InvalidInput(fmt::format("{}: {} must be {}, not {}", name, parameter.name,
                                       number != nullptr ? "a number" : "a list of numbers", std::string(py::repr(value))));
      }
    }
    for (const auto& [key, ignored] : parameters) {
      const std::string given = py::str(key);
      require(std::find(names.begin(), names.end(), given) != names.end(),
              [&] { return fmt::format("{}: unknown parameter '{}'{}", name, given, internal::hint(given, names)); });
    }
    found = std::move(one);
  });
  require(found.has_value(), [&] { return fmt::format("unknown waveform family '{}'{}", name, internal::hint(name, families)); });
  static_cast<void>(signal(*found));
  return {std::move(*found)};
}

py::dict parameters_of(const PyWaveform& waveform) {
  py::dict all;
  std::visit(
      [&]<class Family>(const Family& family) {
        for (const Parameter<Family>& parameter : FamilyOf<Family>::parameters)
          std::visit([&](const auto member) { all[py::str(std::string(parameter.name))] = family.*member; }, parameter.member);
      },
      waveform.value);
  return all;
}

py::array_t<double> voltages(const PyWaveform& waveform,
                             const py::array_t<double, py::array::c_style | py::array::forcecast>& times) {
  const Signal commanded = signal(waveform.value);
  py::array_t<double> volts(std::vector<py::ssize_t>(times.shape(), times.shape() + times.ndim()));
  for (py::ssize_t i = 0; i < times.size(); ++i) volts.mutable_data()[i] = commanded.voltage(times.data()[i]);
  return volts;
}

// Returns a waveform as a table of samples at the times k / rate, connected by straight lines, with the hold voltage as the
// last row.
PyWaveform resampled(const PyWaveform& waveform, double rate, double end) {
  require(rate > 0 && end > 0 && std::isfinite(rate * end) && rate * end <= 1e7,
          "resampled: rate and end must be above 0, and at most 1e7 samples");
  const Signal commanded = signal(waveform.value);
  Table table;
  const auto count = static_cast<std::size_t>(std::ceil(rate * end));
  for (std::size_t k = 0; k <= count; ++k) {
    table.time.push_back(static_cast<double>(k) / rate);
    table.voltage.push_back(commanded.voltage(table.time.back()));
  }
  table.voltage.back() = commanded.hold_level();
  return {table};
}

}  // namespace

void bind_waveforms(py::module_& m) {
  py::class_<PythonWaveform, std::shared_ptr<PythonWaveform>>(m, "PythonWaveform")
      .def(py::init([](std::string name, const std::vector<std::tuple<std::string, double, double, double>>& parameters,
                       py::object breakpoints, py::object voltage) {
        std::vector<OwnParameter> own;
        for (const auto& [key, lower, upper, start] : parameters)
          own.push_back({.name = key, .lower = lower, .upper = upper, .start = start});
        return std::make_shared<PythonWaveform>(std::move(name), std::move(own), std::move(breakpoints), std::move(voltage));
      }));
  py::class_<PythonObjective, std::shared_ptr<PythonObjective>>(m, "PythonObjective")
      .def(py::init<std::string, py::object, bool>());
  py::class_<PyWaveform>(m, "Waveform")
      .def_static("made", &made)
      .def_static("own",
                  [](const std::shared_ptr<PythonWaveform>& waveform, const std::optional<std::vector<double>>& x) {
                    Own one = own(waveform);
                    if (x) one.x = *x;
                    waveform->first_error().rethrow();
                    static_cast<void>(signal(one));
                    return PyWaveform{one};
                  })
      .def_property_readonly("family", [](const PyWaveform& w) { return std::string(family(w.value)); })
      .def_property_readonly("parameters", &parameters_of)
      .def_property_readonly("hold_level", [](const PyWaveform& w) { return signal(w.value).hold_level(); })
      .def_property_readonly("breakpoints", [](const PyWaveform& w) { return signal(w.value).breakpoints(); })
      .def("voltage", &voltages)
      .def("range",
           [](const PyWaveform& w) {
             const Signal::Range range = signal(w.value).range();
             return std::pair(range.minimum, range.maximum);
           })
      .def("peak_slew", [](const PyWaveform& w) { return signal(w.value).peak_slew(); })
      .def("scaled", [](const PyWaveform& w, double volts, double time) { return PyWaveform{scaled(w.value, volts, time)}; })
      .def("resampled", &resampled)
      .def("points",
           [](const PyWaveform& w, double end, double tolerance) { return polyline(signal(w.value), end, tolerance, 0); })
      .def("csv",
           [](const PyWaveform& w, const std::string& name, double end) {
             return csv({{name, signal(w.value)}}, end);
           })
      .def("spice", [](const PyWaveform& w, const std::string& name, double end) {
        return spice_pwl({{name, signal(w.value)}}, end);
      });
}

}  // namespace softland::python
