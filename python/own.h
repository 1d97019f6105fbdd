// Waveforms and objectives that are Python functions.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "objectives/own_objective.h"
#include "waveforms/own_waveform.h"

namespace softland::python {

/// Keeps the first exception of Python functions that the library calls. The library treats a waveform whose function throws as
/// infeasible, and continues; this class raises the exception after the computation.
class FirstError {
 public:
  void keep(std::exception_ptr error) {
    const std::scoped_lock lock(lock_);
    if (!first_) first_ = std::move(error);
  }
  [[nodiscard]] bool is_there() const {
    const std::scoped_lock lock(lock_);
    return first_ != nullptr;
  }
  /// Throws the stored exception, if any, and removes it from this object.
  void rethrow() {
    std::unique_lock lock(lock_);
    const std::exception_ptr first = std::exchange(first_, nullptr);
    lock.unlock();
    if (first) std::rethrow_exception(first);
  }

 private:
  mutable std::mutex lock_;
  std::exception_ptr first_;
};

/// A voltage that a Python function computes for an array of times. A polynomial approximates the voltage between two
/// breakpoints, through Chebyshev points of the second kind. The number of points doubles until the polynomial through every
/// other point gives the remaining values, with an error below own_waveform_accuracy: a candidate waveform of a search takes a
/// few calls. Barycentric formula: J.-P. Berrut & L. N. Trefethen, SIAM Review 46 (2004) 501, eq. 4.2.
class PythonWaveform final : public OwnWaveform {
 public:
  /// `voltage` is a function (times, x) -> volts of arrays; `breakpoints` is a function (x) -> times, or an array of times.
  PythonWaveform(std::string name, std::vector<OwnParameter> parameters, pybind11::object breakpoints, pybind11::object voltage);
  PythonWaveform(const PythonWaveform&) = delete;
  PythonWaveform& operator=(const PythonWaveform&) = delete;
  ~PythonWaveform() override;

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] std::vector<OwnParameter> parameters() const override { return parameters_; }
  [[nodiscard]] std::vector<double> breakpoints(std::span<const double> x) const override;
  [[nodiscard]] double voltage(double time, std::span<const double> x) const override;
  [[nodiscard]] FirstError& first_error() const { return first_; }

 private:
  struct Arc {
    double begin = 0, end = 0;
    std::vector<double> values;  // voltages at Chebyshev points between two breakpoints, from the end to the beginning [V]
    double least = 0, most = 0;  // smallest and largest of the voltages `values` [V]
    [[nodiscard]] double at(double time) const;
  };
  struct Course {
    std::vector<double> x, breakpoints;
    std::vector<Arc> arcs;
  };
  [[nodiscard]] std::shared_ptr<const Course> course(std::span<const double> x) const;
  [[nodiscard]] std::vector<double> called(const std::vector<double>& times, std::span<const double> x) const;

  std::string name_;
  std::vector<OwnParameter> parameters_;
  pybind11::object breakpoints_, voltage_;
  mutable std::mutex lock_;
  // Cache: voltages of the latest candidate waveforms of a search, so that a repeated candidate does not call Python.
  mutable std::vector<std::shared_ptr<const Course>> known_;
  mutable FirstError first_;
};

/// An objective that a Python function computes from the figures of merit of a closing and of the closing under a plain step.
class PythonObjective final : public OwnObjective {
 public:
  PythonObjective(std::string name, pybind11::object value, bool lands_first);
  PythonObjective(const PythonObjective&) = delete;
  PythonObjective& operator=(const PythonObjective&) = delete;
  ~PythonObjective() override;

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] double value(const Metrics& closing, const Metrics& step) const override;
  /// Computes the objective of all devices by one call of the Python function, with arrays.
  void values(std::span<const Metrics> closings, const Metrics& step, std::span<double> values) const override;
  [[nodiscard]] bool lands_first() const override { return lands_first_; }
  [[nodiscard]] FirstError& first_error() const { return first_; }

 private:
  std::string name_;
  pybind11::object value_;
  bool lands_first_;
  mutable FirstError first_;
};

}  // namespace softland::python
