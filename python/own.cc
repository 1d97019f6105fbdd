#include "python/own.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/require.h"
#include "model/constants.h"
#include "objectives/figures.h"

namespace softland::python {

namespace py = pybind11;

namespace {

constexpr std::size_t fewest_intervals = 8, most_intervals = 512, most_known = 64;
// Wanted error of the polynomials that approximate a voltage, relative to the largest voltage. It is far below the guaranteed
// own_waveform_accuracy, because the polynomials of a smooth voltage converge fast.
constexpr double aim = 1e-12;

// Returns Chebyshev point k of the second kind on [begin, end], a cosine of k pi / intervals; point 0 is at the end.
double chebyshev_point(double begin, double end, std::size_t k, std::size_t intervals) {
  return (begin + end) / 2 + (end - begin) / 2 * std::cos(pi * static_cast<double>(k) / static_cast<double>(intervals));
}

py::array_t<double> array(std::span<const double> values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

// Returns a Python object with its type for messages, such as "'abc' (str)".
std::string shown(const py::handle& given) {
  constexpr std::size_t longest = 80;
  std::string text = py::repr(given);
  if (text.size() > longest) text = text.substr(0, longest - 3) + "...";
  return text + " (" + std::string(py::str(py::type::handle_of(given).attr("__name__"))) + ")";
}

// Converts the value that a Python function returned to numbers; `who` names the function in messages.
std::vector<double> numbers(const py::object& given, const std::string& who) {
  // ensure() clears the Python error of a failed conversion, so that require() can report the value.
  const auto values = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  require(static_cast<bool>(values), [&] { return who + " returned " + shown(given) + "; it must return an array of numbers"; });
  return {values.data(), values.data() + values.size()};
}

py::dict figures_of(const Metrics& metrics) {
  py::dict all;
  for (const Figure& figure : figure_table) all[py::str(std::string(figure.quantity()))] = figure.value(metrics);
  return all;
}

}  // namespace

PythonWaveform::PythonWaveform(std::string name, std::vector<OwnParameter> parameters, py::object breakpoints, py::object voltage)
    : name_(std::move(name)),
      parameters_(std::move(parameters)),
      breakpoints_(std::move(breakpoints)),
      voltage_(std::move(voltage)) {}

PythonWaveform::~PythonWaveform() {
  const py::gil_scoped_acquire held;
  breakpoints_ = py::object(), voltage_ = py::object();
}

double PythonWaveform::Arc::at(double time) const {
  const std::size_t intervals = values.size() - 1;
  double above = 0, below = 0;
  for (std::size_t k = 0; k <= intervals; ++k) {
    const double distance = time - chebyshev_point(begin, end, k, intervals);
    if (distance == 0) return values[k];
    const double weight = ((k % 2 == 0) ? 1.0 : -1.0) * (k == 0 || k == intervals ? 0.5 : 1.0) / distance;
    above += weight * values[k], below += weight;
  }
  const double value = above / below;
  // A polynomial may exceed the samples of the voltage by rounding. Set such a value to the extreme sample, so that the
  // waveform keeps the limits of the voltage source.
  if (value < least && least - value <= own_waveform_accuracy * std::max(-least, most)) return least;
  if (value > most && value - most <= own_waveform_accuracy * std::max(-least, most)) return most;
  return value;
}

std::vector<double> PythonWaveform::called(const std::vector<double>& times, std::span<const double> x) const {
  std::vector<double> volts = numbers(voltage_(array(times), array(x)), "the own waveform '" + name_ + "'");
  require(volts.size() == times.size(), [&] {
    return "the own waveform '" + name_ + "' returned " + std::to_string(volts.size()) + " volts for " +
           std::to_string(times.size()) + " times";
  });
  return volts;
}

std::shared_ptr<const PythonWaveform::Course> PythonWaveform::course(std::span<const double> x) const {
  {
    const std::scoped_lock lock(lock_);
    for (const auto& one : known_) {
      if (std::equal(x.begin(), x.end(), one->x.begin(), one->x.end())) return one;
    }
  }
  const auto made = std::make_shared<Course>();
  made->x.assign(x.begin(), x.end());
  try {
    const py::gil_scoped_acquire held;
    made->breakpoints = numbers(PyCallable_Check(breakpoints_.ptr()) != 0 ? breakpoints_(array(x)) : breakpoints_,
                                "the function of the breakpoints of the own waveform '" + name_ + "'");
    double begin = 0;
    for (const double end : made->breakpoints) {
      if (end > begin) made->arcs.push_back({.begin = begin, .end = end});
      begin = end;
    }
    double largest = 0;
    std::vector<std::size_t> open(made->arcs.size());
    for (std::size_t i = 0; i < open.size(); ++i) open[i] = i;
    for (std::size_t intervals = fewest_intervals; !open.empty() && intervals <= most_intervals; intervals *= 2) {
      // One call of the Python function returns the voltages of all intervals between breakpoints that are not accurate yet. At
      // a breakpoint the function returns the voltage after a jump, so the end of an interval is evaluated slightly before the
      // breakpoint.
      std::vector<double> times;
      for (const std::size_t i : open) {
        const Arc& arc = made->arcs[i];
        for (std::size_t k = 0; k <= intervals; ++k)
          times.push_back(k == 0           ? std::nextafter(arc.end, arc.begin)
                          : k == intervals ? arc.begin
                                           : chebyshev_point(arc.begin, arc.end, k, intervals));
      }
      const std::vector<double> volts = called(times, x);
      for (const double one : volts) largest = std::max(largest, std::abs(one));
      std::vector<std::size_t> still;
      for (std::size_t n = 0; n < open.size(); ++n) {
        Arc& arc = made->arcs[open[n]];
        const double* const own = volts.data() + n * (intervals + 1);
        double missed = 0;
        for (std::size_t k = 1; !arc.values.empty() && k < intervals; k += 2)
          missed = std::max(missed, std::abs(arc.at(chebyshev_point(arc.begin, arc.end, k, intervals)) - own[k]));
        const double accuracy = intervals == most_intervals ? own_waveform_accuracy / 10 : aim;
        const bool followed = !arc.values.empty() && missed <= accuracy * largest;
        arc.values.assign(own, own + intervals + 1);
        arc.least = *std::min_element(arc.values.begin(), arc.values.end());
        arc.most = *std::max_element(arc.values.begin(), arc.values.end());
        if (!followed) still.push_back(open[n]);
      }
      open = std::move(still);
    }
    require(open.empty(), [&] { return "the own waveform '" + name_ + "' is not smooth between its breakpoints"; });
  } catch (...) {
    first_.keep(std::current_exception());
    throw;
  }
  const std::scoped_lock lock(lock_);
  if (known_.size() == most_known) known_.erase(known_.begin());
  known_.push_back(made);
  return made;
}

std::vector<double> PythonWaveform::breakpoints(std::span<const double> x) const { return course(x)->breakpoints; }

double PythonWaveform::voltage(double time, std::span<const double> x) const {
  const auto known = course(x);
  if (known->arcs.empty()) {  // without breakpoints the waveform is constant: one call gives its voltage
    const py::gil_scoped_acquire held;
    return called({time}, x)[0];
  }
  const auto after =
      std::upper_bound(known->arcs.begin(), known->arcs.end(), time, [](double t, const Arc& arc) { return t < arc.end; });
  if (after == known->arcs.end()) {  // after its last breakpoint the waveform is constant
    const py::gil_scoped_acquire held;
    return called({time}, x)[0];
  }
  return after->at(time);
}

PythonObjective::PythonObjective(std::string name, py::object value, bool lands_first)
    : name_(std::move(name)), value_(std::move(value)), lands_first_(lands_first) {}

PythonObjective::~PythonObjective() {
  const py::gil_scoped_acquire held;
  value_ = py::object();
}

double PythonObjective::value(const Metrics& closing, const Metrics& step) const {
  const py::gil_scoped_acquire held;
  try {
    const py::object returned = value_(figures_of(closing), figures_of(step));
    try {
      return returned.cast<double>();
    } catch (const py::cast_error&) {
      throw InvalidInput("the objective '" + name_ + "' returned " + shown(returned) + "; it must return a number");
    }
  } catch (...) {
    first_.keep(std::current_exception());
    throw;
  }
}

void PythonObjective::values(std::span<const Metrics> closings, const Metrics& step, std::span<double> values) const {
  const py::gil_scoped_acquire held;
  try {
    py::dict all;
    for (const Figure& figure : figure_table) {
      py::array_t<double> column(static_cast<py::ssize_t>(closings.size()));
      std::transform(closings.begin(), closings.end(), column.mutable_data(),
                     [&](const Metrics& one) { return figure.value(one); });
      all[py::str(std::string(figure.quantity()))] = column;
    }
    const std::vector<double> returned = numbers(value_(all, figures_of(step)), "the objective '" + name_ + "'");
    require(returned.size() == values.size(), [&] {
      return "the objective '" + name_ + "' returned " + std::to_string(returned.size()) + " values for " +
             std::to_string(values.size()) +
             " devices: in a search over devices its figures are arrays, "
             "and it must return an array with a value for each device";
    });
    std::copy(returned.begin(), returned.end(), values.begin());
  } catch (...) {
    first_.keep(std::current_exception());
    throw;
  }
}

}  // namespace softland::python
