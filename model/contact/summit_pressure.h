// Pressure of the highest summit of a contact, over the hardness of the softer surface.
//
//   p / H = 4 E* / (3 pi H) sqrt(d / R)
//
// p is the mean pressure of an elastic spot [Pa]; H hardness [Pa]; E* effective modulus [Pa]; d interference of the contact,
// which is that of its highest summit [m]; R radius of the summits [m]. Source: Hertz 1882.
//
// Limits: a summit yields from p / H = 0.4 on (Chang, Etsion & Bogy 1987, with their K = 0.6), and its pressure is the hardness
// from about 1 on. Above 0.4, p / H is therefore not a true pressure, but shows how deeply the summit is dented: it grows with
// the square root of d.
#pragma once

#include <cmath>
#include <limits>
#include <variant>

#include "model/constants.h"
#include "model/contact/contact.h"

namespace softland {

/// Returns the factor of sqrt(d) in p / H of the header's formula [1/m^0.5], for the pressure of a contact's highest summit at
/// the interference d; NaN for a law without summits, or without a given hardness.
[[nodiscard]] inline double summit_pressure_scale(const Contact& contact) {
  return std::visit(
      [&]<class Law>(const Law& law) {
        double scale = std::numeric_limits<double>::quiet_NaN();
        if constexpr (requires { law.summits; }) {
          double hardness = contact.conduction.hardness;
          if constexpr (requires { law.hardness; }) hardness = law.hardness;
          scale = 4 * law.summits.effective_modulus / (3 * pi * hardness * std::sqrt(law.summits.radius));
        }
        return scale;
      },
      contact.model);
}

}  // namespace softland
