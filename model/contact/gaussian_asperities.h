// The contact law "asperity-gaussian" of a scene: see model/contact/asperity_gaussian.h.
#pragma once

#include <string_view>
#include <variant>

#include "model/contact/hunt_crossley.h"
#include "model/contact/summits.h"

namespace softland {

template <class P>
struct GaussianAsperityContactOf;
using GaussianAsperityContact = GaussianAsperityContactOf<double>;

struct GaussianAsperities {
  static constexpr std::string_view name = "asperity-gaussian";
  static constexpr bool per_area = true;
  Summits summits = {};
  double deviation = 0;  ///< standard deviation of the asperities' heights [m]
  double damping = 0;    ///< damping constant of the contact (Hunt and Crossley) [s/m]

  static consteval auto fields() {
    using Law = GaussianAsperities;
    // clang-format off
    return joined(summit_fields<Law>(), std::to_array<Field<Law>>({
        {.key = "asperity_deviation", .unit = "m", .about = "standard deviation of the summit heights; first touch at four of them above their mean", .in = reach<Law, &Law::deviation>, .required = true, .such_as = "10 nm"},
    }), modulus_fields<Law>(), damping_fields<Law>());
    // clang-format on
  }
  [[nodiscard]] static constexpr GaussianAsperities example() { return {.summits = Summits::example(), .deviation = 30e-9}; }
  /// Returns the interference at which the contact plane reaches the mean of the asperities' summits [m].
  [[nodiscard]] double largest_interference() const;
  [[nodiscard]] std::variant<GaussianAsperityContact, HuntCrossley<GaussianAsperityContact>> law(const ContactPad& pad) const;
};

}  // namespace softland
