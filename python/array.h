// Converts vectors of numbers to NumPy arrays.
#pragma once

#include <pybind11/numpy.h>

#include <vector>

namespace softland::python {

/// Returns a new array of shape (values.size(),) with a copy of the values.
inline pybind11::array_t<double> array(const std::vector<double>& values) {
  return pybind11::array_t<double>(static_cast<pybind11::ssize_t>(values.size()), values.data());
}

}  // namespace softland::python
