#include "waveforms/bspline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace softland {
namespace internal {

double bspline_knot(std::size_t i, std::size_t n) {
  constexpr std::size_t degree = 3;
  return i <= degree ? 0 : static_cast<double>(std::min(i, n) - degree);
}

std::array<std::array<double, 4>, 4> bsplines_of_span(std::size_t j, std::size_t n) {
  using Cubic = std::array<double, 4>;
  // Recursion of Cox and de Boor over the degree d, for knots u_i: B_i,d = (u - u_i) / (u_(i+d) - u_i) B_i,d-1 + (u_(i+d+1) -
  // u) / (u_(i+d+1) - u_(i+1)) B_i+1,d-1. Each B-spline is a polynomial of w on span j, where u = j + w. Of degree 0 only the
  // B-spline number j + 3 is not 0 on this span.
  std::array<Cubic, 5> splines = {};  // the B-splines number j to j + 4 on span j
  splines[3][0] = 1;
  const auto u = static_cast<double>(j);
  for (std::size_t d = 1; d <= 3; ++d) {
    std::array<Cubic, 5> next = {};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto knot = [&](std::size_t further) { return bspline_knot(j + i + further, n); };
      const auto add = [&](const Cubic& spline, double constant, double linear, double over) {
        if (!(over > 0)) return;
        for (std::size_t k = 0; k < 4; ++k) next[i][k] += constant / over * spline[k];
        for (std::size_t k = 0; k < 3; ++k) next[i][k + 1] += linear / over * spline[k];
      };
      add(splines[i], u - knot(0), 1, knot(d) - knot(0));
      add(splines[i + 1], knot(d + 1) - u, -1, knot(d + 1) - knot(1));
    }
    splines = next;
  }
  return {splines[0], splines[1], splines[2], splines[3]};
}

}  // namespace internal

Signal signal(const BSpline& spline, double before) {
  constexpr std::size_t fewest = 4;
  require_of("levels", spline.levels.size() >= fewest,
             [&] { return fmt::format("levels of a bspline are {}; there must be at least {}", spline.levels.size(), fewest); });
  for (std::size_t k = 0; k < spline.levels.size(); ++k) {
    require_of("levels", std::isfinite(spline.levels[k]),
               [&] { return fmt::format("level {} of a bspline is {} V; it must be finite", k + 1, spline.levels[k]); });
  }
  require_of("duration", spline.duration > 0 && std::isfinite(spline.duration),
             [&] { return fmt::format("duration of a bspline is {} s; it must be finite and > 0", spline.duration); });
  return Signal(pieces(spline), before);
}

}  // namespace softland
