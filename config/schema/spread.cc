#include "config/schema/sections.h"

namespace softland::internal {

Section spread_section() {
  constexpr Range up_to_one{.least = 0, .most = 1, .least_open = true};
  return {
      .name = "spread",
      .is_named = true,
      .selector = "distribution",
      .keys = {one_of("distribution", {"normal", "lognormal", "uniform"}, "of the key that varies; its mean is the scene's value")
                   .needed(),
               number("cov", {dimension::none}, up_to_one, "standard deviation over mean").needed().instead("half_width"),
               number("half_width", {}, positive, "in the unit of the key, or a percentage of its value")
                   .needed()
                   .of({"uniform"})
                   .instead("cov")},
      .about = "manufacturing spread of scene keys"};
}

}  // namespace softland::internal
