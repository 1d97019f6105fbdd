// Squeezed gas film under a long strip: incompressible, with slip at the walls. The limit of the compressible film
// (reynolds_film.h) for slow motion.
//
//   f = -mu (a / h)^3 v / (1 + 6 lambda / h)     [N/m], positive towards the electrode
//
// mu is the viscosity [Pa s], a the width [m], h the local gap [m], lambda the mean free path [m], v the velocity towards the
// electrode [m/s]. Valid for lambda / h below about 0.1, squeeze numbers below about 10, strips much longer than wide. Singular
// at h = 0. Source: Burgdorfer 1959, J. Basic Eng. 81, 94-99.
#pragma once

#include "model/gas/film.h"

namespace softland {

/// The law of an incompressible gas film with slip. `P` is the scalar type of the parameters; the scalar type of the state must
/// be constructible from P.
template <class P>
struct SlipFilmOf {
  P viscosity = 0;       ///< viscosity of the gas [Pa s]
  P mean_free_path = 0;  ///< mean free path of the gas [m]
  P width = 0;           ///< width of the beam [m]
  static constexpr bool drive_depends = false;

  /// Returns the load of the gas film on the beam [N/m].
  template <class S>
  S load(S gap, S velocity) const {
    return S(-viscosity * width * width * width) * velocity / (gap * gap * (gap + S(6 * mean_free_path)));
  }
};
using SlipFilm = SlipFilmOf<double>;

/// The parameters of the compressible gas film in a scene (reynolds_film.h). The slip film of this file is its limit for slow
/// motion.
struct ReynoldsGas {
  static constexpr std::string_view name = "reynolds";
  static constexpr FilmLimits limits{.most_knudsen = 0.1, .most_squeeze = 1000};
  static constexpr bool is_compressible = true;
  FilmState film = {};

  static consteval auto fields() { return film_fields<ReynoldsGas>(); }
  [[nodiscard]] static constexpr ReynoldsGas example() { return {}; }
  [[nodiscard]] SlipFilm law(const Film& f) const {
    return {.viscosity = f.viscosity, .mean_free_path = f.mean_free_path, .width = f.width};
  }
};

}  // namespace softland
