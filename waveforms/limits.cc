#include "waveforms/limits.h"

#include <fmt/format.h>

#include <cmath>

#include "base/engineering.h"

namespace softland {

std::string violation(const Signal& signal, const DriverLimits& limits) {
  constexpr double rounding = 1e-12;
  const double slack = rounding * std::fmax(std::abs(limits.min_voltage), std::abs(limits.max_voltage));
  const auto [minimum, maximum] = signal.range();
  if (!(maximum <= limits.max_voltage + slack)) {
    return fmt::format("the voltage reaches {}, above the driver's max_voltage of {}", engineering(maximum, "V"),
                       engineering(limits.max_voltage, "V"));
  }
  if (!(minimum >= limits.min_voltage - slack)) {
    return fmt::format("the voltage reaches {}{}, below the driver's min_voltage of {}", engineering(minimum, "V"),
                       minimum != signal.before() ? ""
                       : minimum == 0             ? " (the voltage of every drive before t = 0)"
                                                  : " (its voltage before t = 0)",
                       engineering(limits.min_voltage, "V"));
  }
  if (std::isinf(limits.max_slew)) return {};
  const double slew = signal.peak_slew();
  if (!(slew <= limits.max_slew * (1 + rounding))) {
    const std::string changes = std::isinf(slew) ? "jumps" : "changes at " + engineering(slew, "V/s");
    return fmt::format("the voltage {}, faster than the driver's max_slew of {}", changes, engineering(limits.max_slew, "V/s"));
  }
  return {};
}

}  // namespace softland
