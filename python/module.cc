// The extension module of the Python package softland: functions of the library, with arrays and JSON. Users import the package.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "base/output_lost.h"
#include "base/require.h"
#include "config/invalid_key.h"
#include "config/units.h"
#include "objectives/figures.h"
#include "python/scene.h"
#include "reports/origin.h"
#include "version.h"

namespace py = pybind11;

namespace softland::python {
namespace {

// Raises the Python exception softland.InvalidInput(message, key, file, line).
void raise_invalid(const InvalidInput& error) {
  const auto* key = dynamic_cast<const InvalidKey*>(&error);
  const auto text = [](const std::string& one) { return one.empty() ? py::object(py::none()) : py::object(py::str(one)); };
  const py::object type = py::module_::import("softland._errors").attr("InvalidInput");
  const InvalidKey::Place place = key != nullptr ? key->place() : InvalidKey::Place{};
  PyErr_SetObject(type.ptr(), type(error.what(), text(place.key), text(place.file),
                                   place.line > 0 ? py::object(py::int_(place.line)) : py::object(py::none()))
                                  .ptr());
}

}  // namespace
}  // namespace softland::python

PYBIND11_MODULE(_softland, m) {
  using namespace softland;
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const InvalidInput& invalid) {
      python::raise_invalid(invalid);
    } catch (const Interrupted&) {
      PyErr_SetString(PyExc_KeyboardInterrupt, "interrupted");
    }
  });
  m.attr("version") = std::string(version);
  m.attr("scenes") = SOFTLAND_SCENES;
  py::list families;
  for_each_family([&]<class Family>(const Family&) { families.append(std::string(FamilyOf<Family>::name)); });
  m.attr("families") = families;
  m.def("units", [](const std::string& text) {
    const Quantity quantity = parse_quantity(text);
    return std::pair(quantity.value, unit_symbol(quantity.dimension));
  });
  m.def("figures", [] {
    py::list all;
    for (const Figure& figure : figure_table)
      all.append(py::make_tuple(std::string(figure.quantity()), std::string(figure.unit), std::string(figure.name),
                                std::string(figure.symbol), figure.of_results, figure.of_devices));
    return all;
  });
  python::bind_waveforms(m);
  python::bind_scene(m);
  python::bind_evaluator(m);
  python::bind_search(m);
  python::bind_exploration(m);
  python::bind_tuning(m);
  python::bind_recordings(m);
}
