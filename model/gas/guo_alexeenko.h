// Compact fit of rarefied squeeze-film damping of beams.
//
//   f = -A b (a/h)^c / (1 + B (a/h)^d (lambda/a)^e) v                                     [N/m], positive towards the electrode
//   A = 10.39 kg/(m^2 s),  B = 1.374,  c = 3.100,  d = 1.825,  e = 0.966
//
// f is the force per length, a the width [m], b the beam thickness [m], h the local gap [m], lambda the mean free path [m], v
// the velocity towards the electrode [m/s]. It is a fit to one type of device (nickel beams about 4 um thick and 120 um wide,
// gaps of micrometres, air): the viscosity does not enter and the thickness does. Compared with Gallis & Torczynski the force
// is about twice as strong at 3.5 um and a tenth as strong at 0.1 um. Singular at h = 0. Source: Guo & Alexeenko, J. Micromech.
// Microeng. 19 (2009) 045026, as coded in Purdue PUQ 2.2.
#pragma once

#include <cmath>
#include <concepts>

#include "model/gas/film.h"
#include "model/power.h"

namespace softland {

/// The gas film law of Guo and Alexeenko. `P` is the scalar type of the parameters; the scalar type of the state must be
/// constructible from P.
template <class P>
struct GuoAlexeenkoFilmOf {
  P mean_free_path = 0;            ///< mean free path of the gas [m]
  P width = 0;                     ///< width of the beam [m]
  P thickness = 0;                 ///< thickness of the beam [m]
  P strength = 10.39 * thickness;  // factor A b of the damping in the header's formula [N s/m^2]
  // Factor B (lambda/a)^e of the header's formula, for the rarefaction of the gas.
  P rarefaction = P(1.374) * raised(mean_free_path / width, 0.966);
  static constexpr bool drive_depends = false;

  /// Returns the load of the gas film on the beam [N/m].
  template <class S>
  S load(S gap, S velocity) const {
    const S ratio = S(width) / gap;
    return S(-strength) * velocity * power(ratio, 3.100) / (S(1) + S(rarefaction) * power(ratio, 1.825));
  }

 private:
  /// Returns x^exponent. The standard library's pow is used for doubles, so that results stay the same to the last bit.
  static P raised(const P& x, double exponent) {
    if constexpr (std::same_as<P, double>) {
      return std::pow(x, exponent);
    } else {
      return power(x, exponent);
    }
  }
};
using GuoAlexeenkoFilm = GuoAlexeenkoFilmOf<double>;

/// The parameters of the gas law of Guo and Alexeenko in a scene.
struct GuoAlexeenkoGas {
  static constexpr std::string_view name = "guo-alexeenko";
  static constexpr FilmLimits limits{.needs_thickness = true};
  FilmState film = {};
  double far_gap = not_given;

  static consteval auto fields() { return joined(film_fields<GuoAlexeenkoGas>(), far_fields<GuoAlexeenkoGas>()); }
  [[nodiscard]] static constexpr GuoAlexeenkoGas example() { return {}; }
  [[nodiscard]] GuoAlexeenkoFilm law(const Film& f) const {
    return {.mean_free_path = f.mean_free_path, .width = f.width, .thickness = f.thickness};
  }
};

}  // namespace softland
