// Squeezed gas film under a long strip: incompressible, continuum, over the whole width, also where there is no electrode.
//
//   f = -mu (a / h)^3 v     [N/m], positive towards the electrode
//
// mu is the viscosity [Pa s], a the width [m], h the local gap [m], v the velocity towards the electrode [m/s]: the film always
// opposes the motion. Valid for squeeze numbers 12 mu a^2 omega / (p h^2) below about 10, gaps well above the mean free path
// (65 nm in air), strips much longer than wide. Singular at h = 0: the switch ends a run before any gap vanishes. Source:
// Bognash 2019, eq. 2.8; textbook limit of the Reynolds equation.
#pragma once

#include "model/gas/film.h"

namespace softland {

/// The law of an incompressible gas film under a strip. `P` is the scalar type of the parameters; the scalar type of the state
/// must be constructible from P.
template <class P>
struct StripSqueezeFilmOf {
  P viscosity = 0;  ///< viscosity of the gas [Pa s]
  P width = 0;      ///< width of the beam [m]
  P mu_a3 = viscosity * width * width * width;
  static constexpr bool drive_depends = false;

  /// Returns the load of the gas film on the beam [N/m].
  template <class S>
  S load(S gap, S velocity) const {
    return S(-mu_a3) * velocity / (gap * gap * gap);
  }
  /// Returns the load of the gas film on the beam [N/m] at the gap h, from `root` = h^(-1/4) [m^(-1/4)].
  template <class S>
  [[gnu::always_inline]] S load_by_root(S root, S velocity) const {
    const S square = root * root, inverse = square * square;
    return S(-mu_a3) * velocity * (inverse * inverse * inverse);
  }
};
using StripSqueezeFilm = StripSqueezeFilmOf<double>;

/// The parameters of the strip film in a scene.
struct StripGas {
  static constexpr std::string_view name = "strip";
  static constexpr FilmLimits limits{.most_knudsen = 0.1, .most_squeeze = incompressible};
  FilmState film = {};
  double film_length = not_given, far_gap = not_given;

  static consteval auto fields() { return joined(film_fields<StripGas>(), end_fields<StripGas>(), far_fields<StripGas>()); }
  [[nodiscard]] static constexpr StripGas example() { return {}; }
  [[nodiscard]] StripSqueezeFilm law(const Film& f) const { return {.viscosity = f.viscosity, .width = f.width}; }
};

}  // namespace softland
