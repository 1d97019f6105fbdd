// The contact law "adhesive" of a scene: see model/contact/adhesive.h.
#pragma once

#include <string_view>

#include "model/contact/summits.h"

namespace softland {

template <class P>
struct AdhesiveAsperityContactOf;

struct AdhesiveAsperities {
  static constexpr std::string_view name = "adhesive";
  static constexpr bool per_area = true, sticks = true;
  Summits summits = {};
  double height = 0;           ///< Hm [m]
  double adhesion_energy = 0;  ///< work of adhesion W [J/m^2]

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
  /// All summits touch [m].
  [[nodiscard]] double largest_interference() const { return height; }
  [[nodiscard]] AdhesiveAsperityContactOf<double> law(const ContactPad& pad) const;
};

}  // namespace softland
