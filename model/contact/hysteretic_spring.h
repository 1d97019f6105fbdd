// The contact law "hysteretic" of a scene: see model/contact/memory.h.
#pragma once

#include <string_view>

#include "base/field.h"
#include "model/contact/memory_of.h"
#include "model/contact/summits.h"

namespace softland {

struct HystereticSpring {
  static constexpr std::string_view name = "hysteretic", not_along_pad = many_dents;
  double stiffness = 0;            ///< stiffness of the contact while loading [N/m]
  double unloading_stiffness = 0;  ///< stiffness of the contact while unloading [N/m]

  static consteval auto fields() {
    using Law = HystereticSpring;
    // clang-format off
    return std::to_array<Field<Law>>({
        {.key = "stiffness", .unit = "N/m", .about = "contact force per penetration; hysteretic: while loading", .in = reach<Law, &Law::stiffness>, .required = true},
        {.key = "unloading_stiffness", .unit = "N/m", .about = "not below stiffness; restitution squared is stiffness over this", .in = reach<Law, &Law::unloading_stiffness>, .required = true, .not_below = "stiffness"},
    });
    // clang-format on
  }
  [[nodiscard]] static constexpr HystereticSpring example() { return {.stiffness = 1e4, .unloading_stiffness = 1.5e4}; }
  [[nodiscard]] HystereticContact law(const ContactPad& pad) const;
};

}  // namespace softland
