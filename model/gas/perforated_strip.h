// Squeezed gas film under a long strip with holes, through which gas leaves as well as at both edges.
//
//   f = -R a [1 - tanh(x) / x] v,   x = a / (2 l),   l^2 = h^3 R / (12 mu)      [N/m], positive towards the electrode
//   R = 8 mu (H + 3 pi r0 / 8) / (b^2 r0^2) + 12 mu rc^2 I / h^3,   b = r0 / rc,   I = -ln(b) / 2 - 3/8 + b^2 / 2 - b^4 / 8
//
// mu is the viscosity [Pa s], a the width [m], h the local gap [m], v the velocity towards the electrode [m/s], H the thickness
// of the strip [m], rc and r0 radii of circles of the area of a cell and of a hole, pi rc^2 = pitch^2, pi r0^2 = size^2 [m]. R
// is the mean pressure over v where gas leaves through the holes alone [Pa s/m]. Its first term is Poiseuille's flow in the
// hole, lengthened by Sampson's resistance 3 mu / r0^3 of its two ends together. Its second term is the film from the rim of a
// cell to its hole, whose mean is Reynolds' equation solved on the ring. Along the width p'' - p / l^2 + 12 mu v / h^3 = 0,
// with p = 0 at both edges.
//
// Without holes, l -> infinity, it is the strip film mu (a / h)^3 v; under a strip much wider than l it is R a v. Derived here
// from these textbook flows. Valid for pitches well below the width, gaps well below the pitch and above the mean free path,
// and squeeze numbers below about 10. Singular at h = 0.
#pragma once

#include <cmath>

#include "base/select.h"
#include "model/constants.h"
#include "model/structure/beam_parts.h"

namespace softland {

struct PerforatedStripFilm {
  double viscosity = 0;  ///< viscosity of the gas [Pa s]
  double width = 0;      ///< width of the strip with its holes [m]
  double through = 0;    ///< resistance of the holes (first term of the header's R): pressure over velocity [Pa s/m]
  double around = 0;     ///< resistance of the film around a hole (second term of R), times the cube of the gap [Pa s m^2]
  static constexpr bool drive_depends = false;

  PerforatedStripFilm(double mu, double a, double thickness, const Holes& holes) : viscosity(mu), width(a) {
    const double hole = holes.size / std::sqrt(pi), cell = holes.pitch / std::sqrt(pi), b = hole / cell;
    through = 8 * mu * (thickness + 3 * pi * hole / 8) / (b * b * hole * hole);
    around = 12 * mu * cell * cell * (-std::log(b) / 2 - 3.0 / 8 + b * b / 2 - std::pow(b, 4) / 8);
  }

  /// Returns the load of the gas film on the strip [N/m].
  template <class S>
  S load(S gap, S velocity) const {
    using std::exp;
    using std::sqrt;
    const S cube = gap * gap * gap, resistance = S(through) + S(around) / cube;
    const S x = S(width / 2) / sqrt(cube * resistance / S(12 * viscosity));
    constexpr double wide = 25;  // tanh(x) counts as 1 for larger x: exp(-2 x) is below the rounding error
    const S decayed = select(
        x < wide, [&] { return S(exp(S(-2) * x)); }, [] { return S(0); });
    return -resistance * S(width) * (S(1) - (S(1) - decayed) / ((S(1) + decayed) * x)) * velocity;
  }
};

}  // namespace softland
