// An interval of the real line: where a distribution has its values, or where a figure lies with some confidence.
#pragma once

#include <limits>

namespace softland {

/// Closed; a side without a bound is infinite, an interval that is not known has NaN for both.
struct Interval {
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] bool holds(double value) const { return low <= value && value <= high; }
};

}  // namespace softland
