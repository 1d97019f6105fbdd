// The contact law "adhesive" of a scene: see model/contact/adhesive.h.
#pragma once

#include <cmath>
#include <string_view>

#include "model/contact/summits.h"

namespace softland {

template <class P>
struct AdhesiveAsperityContactOf;

struct AdhesiveAsperities {
  static constexpr std::string_view name = "adhesive";
  static constexpr bool per_area = true, sticks = true;
  Summits summits = {};
  double height = 0;           ///< greatest height of the asperity summits [m]
  double adhesion_energy = 0;  ///< work of adhesion of the surfaces [J/m^2]

  static consteval auto fields() {
    using Law = AdhesiveAsperities;
    // clang-format off
    return joined(summit_fields<Law>(), height_fields<Law>(), modulus_fields<Law>(), std::to_array<Field<Law>>({
        {.key = "adhesion_energy", .unit = "J/m^2", .about = "work of adhesion per area of the pair of surfaces", .in = reach<Law, &Law::adhesion_energy>, .required = true, .such_as = "0.1 J/m^2"},
    }));
    // clang-format on
  }
  [[nodiscard]] static constexpr AdhesiveAsperities example() {
    return {.summits = Summits::example(), .height = 100e-9, .adhesion_energy = 0.05};
  }
  /// Returns the Tabor number (R W^2 / (E*^2 z0^3))^(1/3) with z0 = 0.3 nm, the equilibrium distance of the surfaces. Source:
  /// D. Tabor, J. Colloid Interface Sci. 58 (1977) 2; limits: K. L. Johnson & J. A. Greenwood, ibid. 192 (1997) 326.
  [[nodiscard]] double tabor_number() const {
    constexpr double z0 = 0.3e-9;
    const double modulus = summits.effective_modulus;
    return std::cbrt(summits.radius * adhesion_energy * adhesion_energy / (modulus * modulus * z0 * z0 * z0));
  }
  static constexpr double largest_tabor_number = 1;
  /// Returns the interference at which all asperity summits touch [m].
  [[nodiscard]] double largest_interference() const { return height; }
  [[nodiscard]] AdhesiveAsperityContactOf<double> law(const ContactPad& pad) const;
};

}  // namespace softland
