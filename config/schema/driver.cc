#include "config/schema/sections.h"

namespace softland::internal {

Section driver_section() {
  return {.name = "driver",
          .is_named = true,
          .keys = {number("min_voltage", drive_voltage, any, "default for an electrode: 0 V"),
                   number("max_voltage", drive_voltage, any, "default for an electrode: 1.5 Vdp"),
                   number("max_slew", {dimension::slew_rate}, positive, "absent: unlimited")},
          .about = "limits of the source: hard bounds of every search"};
}

}  // namespace softland::internal
