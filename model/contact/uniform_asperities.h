// The contact law "asperity-uniform" of a scene: see model/contact/asperity_uniform.h.
#pragma once

#include <string_view>
#include <variant>

#include "model/contact/hunt_crossley.h"
#include "model/contact/summits.h"

namespace softland {

template <class P>
struct UniformAsperityContactOf;
using UniformAsperityContact = UniformAsperityContactOf<double>;

struct UniformAsperities {
  static constexpr std::string_view name = "asperity-uniform";
  static constexpr bool per_area = true;
  Summits summits = {};
  double height = 0;   ///< greatest height of the asperity summits [m]
  double damping = 0;  ///< damping constant of the contact (Hunt and Crossley) [s/m]

  [[nodiscard]] bool operator==(const UniformAsperities&) const = default;

  static consteval auto fields() {
    using Law = UniformAsperities;
    return joined(summit_fields<Law>(), height_fields<Law>(), modulus_fields<Law>(), damping_fields<Law>());
  }
  [[nodiscard]] static constexpr UniformAsperities example() { return {.summits = Summits::example(), .height = 100e-9}; }
  /// Returns the interference at which all asperity summits touch [m].
  [[nodiscard]] double largest_interference() const { return height; }
  [[nodiscard]] std::variant<UniformAsperityContact, HuntCrossley<UniformAsperityContact>> law(const ContactPad& pad) const;
};

}  // namespace softland
