// Squeezed film of rarefied gas down to contact: the form of Gallis & Torczynski with coefficients refitted for gaps much
// smaller than the width.
//
//   f = -c v,   c = mu g(h/a) / (1 + 6 X Kn),   Kn = lambda / h                           [N/m], positive towards the electrode
//   g(x) = x^-3 (1 + 6 Z x + 12 E x^2) for x >= 0.015, below that its tangent at 0.015 (with Z and E of the local Kn)
//   X = 5.5964,  Z = 48.62 Kn / (1 + 0.3405 Kn),  E = (1 + 210.79 Kn) / (67.59 Kn)
//
// mu is the viscosity [Pa s] (1.98e-5 in the source), a the width [m], h the local gap [m], lambda the mean free path [m], v
// the velocity towards the electrode [m/s]. f has a continuous derivative at x = 0.015. The law does not hold for continuum
// flow: E diverges as Kn -> 0; 210.79 Kn below 1 is a warning. Unlike the damping of the other films, c FALLS towards contact
// where the tangent is used. Finite at h -> 0. Source: coefficients as coded in the public force code of the Purdue PRISM
// centre (ComputeForce.py); the underlying paper is presumably Parkos et al., J. Microelectromech. Syst. 22 (2013), which we
// have not seen.
#pragma once

#include "base/select.h"
#include "model/gas/film.h"

namespace softland {

/// The gas film law for gaps down to contact. `P` is the scalar type of the parameters; the scalar type of the state must be
/// constructible from P.
template <class P>
struct NearContactFilmOf {
  P viscosity = 0;       ///< viscosity of the gas [Pa s]
  P mean_free_path = 0;  ///< mean free path of the gas [m]
  P width = 0;           ///< width of the beam [m]
  static constexpr bool drive_depends = false;
  static constexpr double near = 0.015;  ///< gap over width below which g(x) is continued by its tangent
  /// Coefficient of Kn in E of the header's formula. The law is for rarefied gas only: `rarefied` times Kn must be well above
  /// 1.
  static constexpr double rarefied = 210.79;

  /// Returns the load of the gas film on the beam [N/m].
  template <class S>
  S load(S gap, S velocity) const {
    const S kn = S(mean_free_path) / gap;
    const S z = S(6 * 48.62) * kn / (S(1) + S(0.3405) * kn);
    const S e = S(12) * (S(1) + S(rarefied) * kn) / (S(67.59) * kn);
    return S(-viscosity) * velocity * shape(gap / S(width), z, e) / (S(1) + S(6 * 5.5964) * kn);
  }

 private:
  /// Returns the factor g of the header's formula at x = gap / width, with the coefficients z = 6 Z and e = 12 E.
  template <class S>
  static S shape(S x, S z, S e) {
    constexpr double r = 1 / near;
    return select(
        x < near,
        [&]() -> S {
          const S value = S(r) * (S(r) * (S(r) + z) + e);
          const S slope = S(-r * r) * (S(r) * (S(3 * r) + S(2) * z) + e);
          return value + slope * (x - S(near));
        },
        [&]() -> S { return (S(1) + x * (z + e * x)) / (x * x * x); });
  }
};
using NearContactFilm = NearContactFilmOf<double>;

/// The parameters of the gas law "near-contact" in a scene.
struct NearContactGas {
  static constexpr std::string_view name = "near-contact";
  static constexpr FilmLimits limits{.least_knudsen = 1 / NearContactFilm::rarefied, .most_squeeze = incompressible};
  FilmState film = {};
  double far_gap = not_given;

  static consteval auto fields() { return joined(film_fields<NearContactGas>(), far_fields<NearContactGas>()); }
  [[nodiscard]] static constexpr NearContactGas example() { return {}; }
  [[nodiscard]] NearContactFilm law(const Film& f) const {
    return {.viscosity = f.viscosity, .mean_free_path = f.mean_free_path, .width = f.width};
  }
};

}  // namespace softland
