// The evaluator for Python: it simulates the closings of devices, given by arrays of their varied values, and returns figures
// of merit.
#include "studies/devices/evaluator.h"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "python/scene.h"

namespace softland::python {

namespace py = pybind11;

namespace {

using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;

Figure figure_named(const std::string& name) {
  const auto found = std::find_if(figure_table.begin(), figure_table.end(), [&](const Figure& f) {
    return Evaluator::measured(f) && (f.quantity() == name || f.key == name || f.symbol == name);
  });
  require(found != figure_table.end(), [&] {
    std::string known;
    for (const Figure& f : figure_table) {
      if (Evaluator::measured(f)) known += (known.empty() ? "" : ", ") + std::string(f.quantity());
    }
    return fmt::format("unknown figure '{}'; choose from {}", name, known);
  });
  return *found;
}

std::unique_ptr<Evaluator> made_evaluator(const PyScene& scene, const std::vector<std::string>& keys,
                                          const std::vector<std::string>& names, const std::string& vdp, double tolerance,
                                          const py::object& on_progress) {
  require(vdp == "nominal" || vdp == "each", [&] { return fmt::format("vdp {}: must be nominal or each", vdp); });
  std::vector<Figure> figures;
  for (const std::string& name : names) figures.push_back(figure_named(name));
  const SceneFile file = scene.file;
  InterruptibleRun run(on_progress);
  return run([&](const Progress& progress) {
    return std::make_unique<Evaluator>(
        file, keys, figures, EvaluatorOptions{.volts = vdp == "each" ? VoltsOf::each : VoltsOf::nominal, .tolerance = tolerance},
        progress);
  });
}

// Returns (figures of merit, status, reasons) of the closings of devices, with a row for each device.
py::tuple evaluate(const Evaluator& evaluator, const Rows& rows, int jobs, const py::object& on_progress) {
  const auto keys = static_cast<py::ssize_t>(evaluator.keys().size()),
             figures = static_cast<py::ssize_t>(evaluator.figures().size());
  require(rows.ndim() == 2 && rows.shape(1) == keys,
          [&] { return fmt::format("evaluator: must be an array of shape (n, {})", keys); });
  const auto count = static_cast<std::size_t>(rows.shape(0));
  py::array_t<double> values({rows.shape(0), figures});
  std::vector<RowEnd> ends(count);
  const std::span<const double> in(rows.data(), static_cast<std::size_t>(rows.size()));
  const std::span<double> out(values.mutable_data(), static_cast<std::size_t>(values.size()));
  InterruptibleRun run(on_progress);
  run([&](const Progress& progress) {
    evaluator.evaluate(in, out, ends, jobs, progress);
    return true;
  });
  // Few statuses of closings occur: each is converted to a Python text once.
  std::map<std::string, py::str> texts;
  py::list status(count);
  py::dict reasons;
  for (std::size_t i = 0; i < count; ++i) {
    status[i] = texts.try_emplace(ends[i].status, ends[i].status).first->second;
    if (!ends[i].reason.empty()) reasons[py::int_(i)] = ends[i].reason;
  }
  return py::make_tuple(values, status, reasons);
}

}  // namespace

void bind_evaluator(py::module_& m) {
  py::class_<Evaluator>(m, "Evaluator")
      .def(py::init(&made_evaluator))
      .def_property_readonly("keys", &Evaluator::keys)
      .def_property_readonly("units", &Evaluator::units)
      .def_property_readonly("nominal",
                             [](const Evaluator& e) {
                               return py::array_t<double>(static_cast<py::ssize_t>(e.nominal().size()), e.nominal().data());
                             })
      .def_property_readonly("figures",
                             [](const Evaluator& e) {
                               std::vector<std::pair<std::string, std::string>> all;
                               for (const Figure& f : e.figures()) all.emplace_back(f.quantity(), f.unit);
                               return all;
                             })
      .def("evaluate", &evaluate)
      .def("jacobian", [](const Evaluator& e, const Rows& row) {
        require(row.ndim() == 1, "jacobian: must be a single row, of shape (keys,)");
        InterruptibleRun run;
        return run([&](const Progress& progress) {
          return e.jacobian({row.data(), static_cast<std::size_t>(row.size())}, progress);
        });
      });
}

}  // namespace softland::python
