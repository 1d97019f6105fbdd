// Two times that a user means to be one: an edge that ends where the next one begins, two fades that meet in the middle.
#pragma once

#include <cmath>
#include <limits>

namespace softland::internal {

/// True when two times [s] differ by no more than the rounding of one sum and of their decimal text. A piece between them would
/// be shorter than any integrator can step.
[[nodiscard]] inline bool coincide(double time, double other) {
  constexpr double roundings = 4;
  return std::abs(time - other) <= roundings * std::numeric_limits<double>::epsilon() * std::abs(other);
}

}  // namespace softland::internal
