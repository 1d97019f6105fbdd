#include "waveforms/limits.h"

#include <fmt/format.h>

#include <cmath>

namespace softland {

std::string violation(const Signal& signal, const DriverLimits& limits) {
  constexpr double rounding = 1e-12;
  const double slack = rounding * std::fmax(std::abs(limits.min_voltage), std::abs(limits.max_voltage));
  const double maximum = signal.maximum();
  if (!(maximum <= limits.max_voltage + slack)) {
    return fmt::format("the voltage reaches {} V, above the driver's max_voltage of {} V", maximum, limits.max_voltage);
  }
  const double minimum = signal.minimum();
  if (!(minimum >= limits.min_voltage - slack)) {
    return fmt::format("the voltage reaches {} V{}, below the driver's min_voltage of {} V", minimum,
                       minimum == 0 ? " (where every drive starts)" : "", limits.min_voltage);
  }
  const double slew = signal.peak_slew();
  if (!(slew <= limits.max_slew * (1 + rounding))) {
    if (std::isinf(slew)) return fmt::format("the voltage jumps, faster than the driver's max_slew of {} V/s", limits.max_slew);
    return fmt::format("the voltage changes at {} V/s, faster than the driver's max_slew of {} V/s", slew, limits.max_slew);
  }
  return {};
}

}  // namespace softland
