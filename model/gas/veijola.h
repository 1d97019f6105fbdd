// Squeezed film under a long strip of rarefied gas: the strip film with an effective viscosity.
//
//   f = -mu_eff (a / h)^3 v,   mu_eff = mu / (1 + 9.638 Kn^1.159),   Kn = lambda / h     [N/m], positive towards the electrode
//
// mu is the viscosity [Pa s], a the width [m], h the local gap [m], lambda the mean free path [m], v the velocity towards the
// electrode [m/s]. The fit is within 5 % of the linearised Boltzmann solution of Poiseuille flow for Kn up to 880.
// Incompressible: valid for squeeze numbers 12 mu_eff a^2 omega / (p h^2) below about 10. The limit Kn -> 0 is the strip film.
// Singular at h = 0. Source: Veijola, Kuisma, Lahdenpera & Ryhanen, Sensors and Actuators A 48 (1995) 239, for the flow
// conductance of Fukui & Kaneko 1988.
#pragma once

#include "model/gas/film.h"
#include "model/power.h"

namespace softland {

/// The gas film law of Veijola. `P` is the scalar type of the parameters; the scalar type of the state must be constructible
/// from P.
template <class P>
struct VeijolaFilmOf {
  P viscosity = 0;       ///< viscosity of the gas [Pa s]
  P mean_free_path = 0;  ///< mean free path of the gas [m]
  P width = 0;           ///< width of the beam [m]
  P mu_a3 = viscosity * width * width * width;
  static constexpr bool drive_depends = false;

  /// Returns the load of the gas film on the beam [N/m].
  template <class S>
  S load(S gap, S velocity) const {
    return S(-mu_a3) * velocity / (gap * gap * gap * (S(1) + S(9.638) * power(S(mean_free_path) / gap, 1.159)));
  }
};
using VeijolaFilm = VeijolaFilmOf<double>;

/// The parameters of the gas law of Veijola in a scene.
struct VeijolaGas {
  static constexpr std::string_view name = "veijola";
  static constexpr FilmLimits limits{.most_knudsen = 880, .most_squeeze = incompressible};
  FilmState film = {};
  double film_length = not_given, far_gap = not_given;

  static consteval auto fields() { return joined(film_fields<VeijolaGas>(), end_fields<VeijolaGas>(), far_fields<VeijolaGas>()); }
  [[nodiscard]] static constexpr VeijolaGas example() { return {}; }
  [[nodiscard]] VeijolaFilm law(const Film& f) const {
    return {.viscosity = f.viscosity, .mean_free_path = f.mean_free_path, .width = f.width};
  }
};

}  // namespace softland
