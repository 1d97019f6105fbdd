// An interval of the real line: the support of a distribution, or a confidence interval of a figure.
#pragma once

#include <limits>

namespace softland {

/// A closed interval; an end without a bound is infinite, an unknown interval has NaN for both ends.
struct Interval {
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] bool holds(double value) const { return low <= value && value <= high; }
};

}  // namespace softland
