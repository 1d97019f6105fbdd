// Squeezed gas film between two vertical walls on a substrate: one long edge is open; at the other the gas can only leave
// through a slit under the moving wall. The fingers of gap-closing actuators etched from the device layer of a
// silicon-on-insulator wafer move in this way.
//
//   f = -mu (a / h)^3 v (4 + r) / (1 + r),   r = a s^3 / (l h^3)     [N/m], positive towards the electrode
//
// mu is the viscosity [Pa s], a the width of the film (height of the wall) [m], h the local gap [m], s the height of the slit
// [m], l its length up to where the pressure is ambient [m] (half the thickness of the wall when the film on its other side
// widens as this film is squeezed), v the velocity towards the electrode [m/s]. r compares the flows through slit and film: a
// wide slit, r -> infinity, gives the strip open at both edges, a closed slit four times its damping, the strip of twice the
// width. Derived from Reynolds' equation with p = 0 at the open edge and -dp/dx h^3 = p s^3 / l at the other; the same factor
// as Li, Rouf & Horsley, Transducers 2013, for lateral oscillators. Continuum, incompressible, Poiseuille flow in the slit.
// Singular at h = 0.
#pragma once

#include "model/gas/film.h"

namespace softland {

/// The law of a gas film between walls, with a slit under the moving wall. `P` is the scalar type of the parameters; the scalar
/// type of the state must be constructible from P.
template <class P>
struct StripOverSlitOf {
  P viscosity = 0;    ///< viscosity of the gas [Pa s]
  P width = 0;        ///< width of the film, the height of the wall [m]
  P slit_height = 0;  ///< height of the slit under the wall [m]
  P slit_length = 0;  ///< length of the slit, up to ambient pressure [m]
  P mu_a3 = viscosity * width * width * width;
  /// The product r h^3 of the header's formula, where r is flow through the slit over flow through the film [m^3].
  P passing = width * slit_height * slit_height * slit_height / slit_length;
  static constexpr bool drive_depends = false;

  /// Returns the load of the gas film on the wall [N/m].
  template <class S>
  S load(S gap, S velocity) const {
    const S cube = gap * gap * gap;
    return S(-mu_a3) * velocity * (S(4) * cube + S(passing)) / (cube * (cube + S(passing)));
  }
};
using StripOverSlit = StripOverSlitOf<double>;

/// The parameters of the gas law "strip-slit" in a scene.
struct StripSlitGas {
  static constexpr std::string_view name = "strip-slit";
  static constexpr FilmLimits limits{.most_knudsen = 0.1, .most_squeeze = incompressible};
  FilmState film = {};
  double film_length = not_given, slit_height = not_given, slit_length = not_given, far_gap = not_given;

  static consteval auto fields() {
    using Law = StripSlitGas;
    // clang-format off
    return joined(film_fields<Law>(), end_fields<Law>(), std::to_array<Field<Law>>({
        {.key = "slit_height", .unit = "m", .about = "of the slit through which the gas leaves at one edge", .in = reach<Law, &Law::slit_height>, .required = true},
        {.key = "slit_length", .unit = "m", .about = "of that slit, up to where the pressure is ambient", .in = reach<Law, &Law::slit_length>, .required = true},
    }), far_fields<Law>());
    // clang-format on
  }
  [[nodiscard]] static constexpr StripSlitGas example() { return {.slit_height = 2e-6, .slit_length = 2e-6}; }
  [[nodiscard]] StripOverSlit law(const Film& f) const {
    return {.viscosity = f.viscosity, .width = f.width, .slit_height = slit_height, .slit_length = slit_length};
  }
};

}  // namespace softland
