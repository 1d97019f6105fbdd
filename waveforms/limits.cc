#include "waveforms/limits.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "base/engineering.h"

namespace softland {

namespace {

// Returns two values with as few digits as tell them apart.
std::array<std::string, 2> distinct(double one, double other, const char* unit) {
  std::array<std::string, 2> words;
  for (const int digits : {5, 8, 12}) {
    words = {engineering(one, unit, digits), engineering(other, unit, digits)};
    if (words[0] != words[1]) break;
  }
  return words;
}

}  // namespace

std::string violation(const Signal& signal, const DriverLimits& limits) {
  constexpr double rounding = 1e-12;
  const double slack = rounding * std::fmax(std::abs(limits.min_voltage), std::abs(limits.max_voltage));
  const auto [minimum, maximum] = signal.range();
  if (!(maximum <= limits.max_voltage + slack)) {
    const auto [reached, limit] = distinct(maximum, limits.max_voltage, "V");
    return fmt::format("the voltage reaches {}, above the driver's max_voltage of {}", reached, limit);
  }
  if (!(minimum >= limits.min_voltage - slack)) {
    const auto [reached, limit] = distinct(minimum, limits.min_voltage, "V");
    return fmt::format("the voltage reaches {}{}, below the driver's min_voltage of {}", reached,
                       minimum != signal.before() ? ""
                       : minimum == 0             ? " (the voltage of every drive before t = 0)"
                                                  : " (its voltage before t = 0)",
                       limit);
  }
  if (std::isinf(limits.max_slew)) return {};
  const double slew = signal.peak_slew();
  if (!(slew <= limits.max_slew * (1 + rounding))) {
    const auto [reached, limit] = distinct(slew, limits.max_slew, "V/s");
    const std::string changes = std::isinf(slew) ? "jumps" : "changes at " + reached;
    return fmt::format("the voltage {}, faster than the driver's max_slew of {}", changes, limit);
  }
  return {};
}

}  // namespace softland
