#include "config/scene.h"
#include "config/schema/sections.h"

namespace softland::internal {

Section calibration_section() {
  return {.name = "calibration",
          .is_named = true,
          .beside = classes_key,
          .keys = {number("error", {dimension::none, dimension::time}, {.least = 0, .most = 0.5},
                          "one standard deviation of the measurement, normal: relative, or for a time in its unit")
                       .by_default("'0 %'")},
          .about =
              "per-device calibration, measured before actuation: NAME is Vdp, frequency, piezo (static deflection per volt, "
              "divided by the contact gap) or time (closing time under a step to 1.2 Vdp)"};
}

}  // namespace softland::internal
