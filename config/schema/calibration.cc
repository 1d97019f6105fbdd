#include "config/scene.h"
#include "config/schema/sections.h"

namespace softland::internal {

Section calibration_section() {
  return {.name = "calibration",
          .is_named = true,
          .beside = classes_key,
          .keys = {number("error", {dimension::none, dimension::time}, {.least = 0, .most = 0.5},
                          "of the measurement, one standard deviation; of a time in its unit")
                       .by_default("'0 %'")},
          .about =
              "what is measured on every device before it is driven: NAME is Vdp, frequency, piezo, "
              "the static deflection per volt on it over the contact gap, or time, that of closing under a step to 1.2 Vdp"};
}

}  // namespace softland::internal
