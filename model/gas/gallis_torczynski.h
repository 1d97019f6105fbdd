// Squeezed film under a long strip of rarefied gas, with the pressure that remains at the strip's edges.
//
//   f = -mu (a / h)^3 [1 + 6 Z (h/a) + 12 E (h/a)^2] / (1 + 6 X Kn) v,   Kn = lambda / h    [N/m], positive towards the electrode
//   X = (1 + 8.834 Kn) / (1 + 5.118 Kn),  Z = (0.634 + 1.572 Kn) / (1 + 0.537 Kn),  E = (0.445 + 11.20 Kn) / (1 + 5.510 Kn)
//
// f is the force per length, mu the viscosity [Pa s], a the width [m], h the local gap [m], lambda the mean free path [m], v
// the velocity towards the electrode [m/s]. X describes slip at the walls, Z and E pressure and flow at the edges, fitted to
// direct simulation Monte Carlo with full accommodation. Incompressible: valid for squeeze numbers 12 mu a^2 omega / (p h^2)
// below about 10. The limit Kn -> 0 and h/a -> 0 is the strip film. Singular at h = 0. Source: Gallis & Torczynski, J.
// Microelectromech. Syst. 13 (2004) 653, eqs. 16-18.
#pragma once

#include "model/gas/film.h"

namespace softland {

/// The gas film law of Gallis and Torczynski. `P` is the scalar type of the parameters; the scalar type of the state must be
/// constructible from P.
template <class P>
struct GallisTorczynskiFilmOf {
  P viscosity = 0;       ///< viscosity of the gas [Pa s]
  P mean_free_path = 0;  ///< mean free path of the gas [m]
  P width = 0;           ///< width of the beam [m]
  static constexpr bool drive_depends = false;

  /// Returns the load of the gas film on the beam [N/m].
  template <class S>
  S load(S gap, S velocity) const {
    const S kn = S(mean_free_path) / gap, x = gap / S(width);
    const S slip = (S(1) + S(8.834) * kn) / (S(1) + S(5.118) * kn);
    const S pressure = (S(0.634) + S(1.572) * kn) / (S(1) + S(0.537) * kn);
    const S flow = (S(0.445) + S(11.20) * kn) / (S(1) + S(5.510) * kn);
    return S(-viscosity) * velocity * (S(1) + x * (S(6) * pressure + S(12) * flow * x)) / (x * x * x * (S(1) + S(6) * slip * kn));
  }
};
using GallisTorczynskiFilm = GallisTorczynskiFilmOf<double>;

/// The parameters of the gas law of Gallis and Torczynski in a scene.
struct GallisTorczynskiGas {
  static constexpr std::string_view name = "gallis-torczynski";
  static constexpr FilmLimits limits{.most_squeeze = incompressible};
  FilmState film = {};
  double far_gap = not_given;

  static consteval auto fields() { return joined(film_fields<GallisTorczynskiGas>(), far_fields<GallisTorczynskiGas>()); }
  [[nodiscard]] static constexpr GallisTorczynskiGas example() { return {}; }
  [[nodiscard]] GallisTorczynskiFilm law(const Film& f) const {
    return {.viscosity = f.viscosity, .mean_free_path = f.mean_free_path, .width = f.width};
  }
};

}  // namespace softland
