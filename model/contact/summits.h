// The summits (asperities) of a rough surface: parameters that several contact laws share.
#pragma once

#include <cmath>

#include "base/field.h"

namespace softland {

/// The total size of a contact's equal pads, from which a contact law computes the number of asperity summits.
struct ContactPad {
  double width = 0;   ///< width of the contact pad times the number of equal pads [m]
  double length = 0;  ///< length of the contact pad [m]
  double count = 1;   ///< number of equal contact pads across the beam
};

struct Summits {
  double radius = 0;             ///< radius of the asperity summits [m]
  double density = 0;            ///< asperity summits per area [1/m^2]
  double effective_modulus = 0;  ///< effective modulus of the contacting surfaces [Pa]

  [[nodiscard]] bool operator==(const Summits&) const = default;

  /// Returns the number of asperity summits under the pad.
  [[nodiscard]] double count(const ContactPad& pad) const { return density * pad.width * pad.length; }
  /// Returns N E* sqrt(R) for the N summits under the pad [N/m^1.5]; Hertz's force of equally high summits is 4/3 of this value
  /// times interference^1.5.
  [[nodiscard]] double hertz(const ContactPad& pad) const { return count(pad) * effective_modulus * std::sqrt(radius); }

  /// Returns the asperity summits of gold on gold, for tests.
  [[nodiscard]] static constexpr Summits example() { return {.radius = 100e-9, .density = 1e11, .effective_modulus = 48e9}; }
};

// clang-format off
// Returns the scene-file keys of radius and density of a contact law's member `summits`.
template <class Law>
[[nodiscard]] consteval auto summit_fields() {
  return std::to_array<Field<Law>>({
      {.key = "asperity_radius", .unit = "m", .about = "radius of the summits", .in = reach<Law, &Law::summits, &Summits::radius>, .required = true, .such_as = "100 nm"},
      {.key = "asperity_density", .unit = "1/m^2", .about = "summits per area", .in = reach<Law, &Law::summits, &Summits::density>, .required = true, .such_as = "1e11 1/m^2"},
  });
}
/// Returns the scene-file key that sets the effective modulus. It is not part of summit_fields(), since a law lists its keys
/// for the summit heights between the two.
template <class Law>
[[nodiscard]] consteval auto modulus_fields() {
  return std::to_array<Field<Law>>({
      {.key = "effective_modulus", .unit = "Pa", .about = "E* of the pair of surfaces", .in = reach<Law, &Law::summits, &Summits::effective_modulus>, .required = true, .such_as = "48 GPa"},
  });
}
/// Returns the scene-file key that sets the greatest height of asperity summits, whose heights are uniform from 0 on.
template <class Law>
[[nodiscard]] consteval auto height_fields() {
  return std::to_array<Field<Law>>({
      {.key = "asperity_height", .unit = "m", .about = "summit heights are uniform on [0, asperity_height]", .in = reach<Law, &Law::height>, .required = true, .such_as = "100 nm"},
  });
}
// clang-format on

}  // namespace softland
