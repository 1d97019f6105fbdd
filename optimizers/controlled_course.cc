#include <algorithm>
#include <cmath>
#include <utility>

#include "optimizers/collocation.h"

namespace softland {
namespace {

using Eigen::Index;

// Returns the index of the interval between the times `at` that contains the time `fraction`, both as fractions of the final
// time T, and the place within this interval from 0 to 1.
std::pair<std::size_t, double> interval_of(const std::vector<double>& at, double fraction) {
  const auto above = std::upper_bound(at.begin() + 1, at.end() - 1, fraction);
  const auto i = static_cast<std::size_t>(above - at.begin()) - 1;
  return {i, std::clamp((fraction - at[i]) / (at[i + 1] - at[i]), 0.0, 1.0)};
}

}  // namespace

Eigen::VectorXd ControlledCourse::state_at(double fraction) const {
  const auto [i, inside] = interval_of(points, fraction);
  const auto at = static_cast<Index>(i);
  return (1 - inside) * states.col(at) + inside * states.col(at + 1);
}

Eigen::VectorXd ControlledCourse::control_at(double fraction) const {
  const auto [i, inside] = interval_of(knots, fraction);
  const auto at = static_cast<Index>(i);
  if (controls.cols() + 1 == static_cast<Index>(knots.size())) return controls.col(at);
  return (1 - inside) * controls.col(at) + inside * controls.col(at + 1);
}

std::vector<double> refined_knots(const ControlledCourse& course, const std::vector<ControlBound>& bounds, double shortest) {
  const std::vector<double>& knots = course.knots;
  const std::size_t intervals = knots.size() - 1;
  constexpr double near = 0.01;  // a control is on a bound if closer than this share of its range
  std::vector<bool> changes(intervals, false);
  for (std::size_t i = 0; i < intervals; ++i) {
    for (std::size_t k = 0; k < bounds.size(); ++k) {
      const double range = bounds[k].upper - bounds[k].lower;
      const auto at = [&](std::size_t j) {
        return (course.controls(static_cast<Index>(k), static_cast<Index>(j)) - bounds[k].lower) / range;
      };
      const bool between = at(i) > near && at(i) < 1 - near;
      const bool jumps = i + 1 < static_cast<std::size_t>(course.controls.cols()) && std::abs(at(i + 1) - at(i)) > near;
      if (!between && !jumps) continue;
      changes[i] = true;
      if (i > 0) changes[i - 1] = changes[i - 1] || between;
      if (i + 1 < intervals) changes[i + 1] = true;
    }
  }
  std::vector<double> refined;
  for (std::size_t i = 0; i < intervals; ++i) {
    refined.push_back(knots[i]);
    if (changes[i] && knots[i + 1] - knots[i] >= 2 * shortest) refined.push_back((knots[i] + knots[i + 1]) / 2);
  }
  refined.push_back(1);
  return refined;
}

}  // namespace softland
