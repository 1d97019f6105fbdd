// Reads files of instruments for Python, and exports the waveforms of a scene for other programs.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/read_keys.h"
#include "exchange/level_edges.h"
#include "exchange/recording.h"
#include "python/array.h"
#include "python/scene.h"
#include "reports/recording_report.h"

namespace softland::python {

namespace py = pybind11;

namespace {

using Column = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::vector<double> numbers(const Column& column) { return {column.data(), column.data() + column.size()}; }

Recording read(const std::filesystem::path& file, const std::vector<std::string>& assignments) {
  const ReadKeys keys = read_keys(assignments);
  InterruptibleRun run;
  return run([&](const Progress&) {
    Recording found = read_recording(file.string(), keys);
    if (!keys.column.empty() || keys.column_number > 0) found.channels = {channel_of(found, keys, "")};
    return found;
  });
}

// Returns (name, heading, unit, column in the file, values in SI units) of every channel.
py::list channels_of(const Recording& recording) {
  py::list all;
  for (const Channel& channel : recording.channels) {
    std::vector<double> values = channel.values;
    for (double& one : values) one /= channel.per_si;
    all.append(py::make_tuple(channel.name, channel.heading, channel.unit, channel.column, array(values), channel.is_voltage));
  }
  return all;
}

// Returns the times from t = 0 on at which a contact closes or opens: rows of time [s] and state, 1 for closing and 0 for
// opening.
py::array_t<double> edges(const Column& times, const Column& volts, double threshold, bool is_closed_below, double hysteresis,
                          double merge, bool from_zero) {
  require(times.ndim() == 1 && times.size() == volts.size() && times.size() > 0,
          "times and volts: must have the same shape (n,)");
  require(hysteresis >= 0 && merge >= 0, "hysteresis and merge: must be at least 0");
  const Trace trace{.times = numbers(times), .values = numbers(volts), .note = {}};
  for (std::size_t i = 0; i < trace.times.size(); ++i)
    require(std::isfinite(trace.times[i]) && std::isfinite(trace.values[i]) && (i == 0 || trace.times[i] >= trace.times[i - 1]),
            "times and volts: must be finite, and times must not decrease");
  const ThresholdKeys keys{.threshold = threshold, .hysteresis = hysteresis, .is_closed_below = is_closed_below, .merge = merge};
  const std::vector<LevelEdge> found = from_zero ? contact_edges(trace, keys, "the trace") : level_edges(trace, keys);
  py::array_t<double> rows({static_cast<py::ssize_t>(found.size()), py::ssize_t{2}});
  auto to = rows.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < to.shape(0); ++i) {
    to(i, 0) = found[static_cast<std::size_t>(i)].time;
    to(i, 1) = found[static_cast<std::size_t>(i)].closed ? 1 : 0;
  }
  return rows;
}

}  // namespace

void bind_recordings(py::module_& m) {
  py::class_<Recording>(m, "Recording")
      .def_static("read", &read)
      .def_readonly("file", &Recording::file)
      .def_readonly("format", &Recording::format)
      .def_property_readonly("times", [](const Recording& r) { return array(r.times); })
      .def_property_readonly("channels", &channels_of)
      .def_readonly("left_out", &Recording::left_out)
      .def_readonly("notes", &Recording::notes)
      .def_readonly("is_breakpoints", &Recording::is_breakpoints)
      .def_property_readonly("text", [](const Recording& r) { return recording_text(r); })
      .def_property_readonly("svg", [](const Recording& r) { return recording_svg(r); });
  m.def("contact_edges", &edges);
}

}  // namespace softland::python
