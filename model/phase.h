// How far free modes turn in a time: the exact motion between two instants of q'' = -omega^2 q + constant, for a few modes at
// once.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace softland {

inline constexpr std::size_t phase_lanes = 4;
using PhaseLane = Eigen::Array<double, phase_lanes, 1>;

/// Largest phase turn() is exact for, to rounding.
inline constexpr double largest_phase = 2;

struct Turn {
  PhaseLane cosine, sine;
  PhaseLane slack;  ///< 1 - cosine, without cancellation
};

/// Taylor series of cosine and sine at half the phase; the first term left out is below 1e-18.
[[nodiscard]] inline Turn turn(const PhaseLane& phase) {
  const PhaseLane x = phase / 2, x2 = x * x;
  PhaseLane cosine = PhaseLane::Constant(1), over_x = cosine;
  for (int k = 18; k > 0; k -= 2) {
    cosine = 1 - x2 / (k * (k - 1)) * cosine;
    over_x = 1 - x2 / (k * (k + 1)) * over_x;
  }
  const PhaseLane sine = x * over_x, slack = 2 * sine * sine;
  return {.cosine = 1 - slack, .sine = 2 * sine * cosine, .slack = slack};
}

/// Per mode, padded to whole lanes with `idle`.
[[nodiscard]] inline std::vector<double> padded_to_lanes(std::vector<double> values, double idle) {
  values.resize((values.size() + phase_lanes - 1) / phase_lanes * phase_lanes, idle);
  return values;
}

}  // namespace softland
