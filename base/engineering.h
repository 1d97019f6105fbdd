// Formats numbers with unit for messages, in the notation of scene files: "60 um", "78 GPa".
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

namespace softland {

/// Returns `value` [unit] with the prefix, femto to giga, that leaves one to three digits before the point: 6e-05, "m" -> "60
/// um". The text has at most `digits` significant digits; below a million it always shows all digits before the point: 2500
/// stays 2500. Twelve digits do not show rounding errors in a number that was typed. No prefix is used for 0, for values beyond
/// the prefixes, and for a unit that takes none: "kg/m^3", "1/m^2", "m^2", "" or "Vdp" (a multiple of the dynamic pull-in
/// voltage).
///
/// A slew rate from 1 kV/s to 1 GV/us is shown in V/us, as drivers' data sheets do.
[[nodiscard]] inline std::string engineering(double value, std::string_view unit, int digits = 12) {
  constexpr double fast = 1e3, fastest = 1e15, per_microsecond = 1e-6;
  if (unit == "V/s" && std::abs(value) >= fast && std::abs(value) < fastest)
    return engineering(per_microsecond * value, "V/us", digits);
  constexpr std::array<std::pair<int, std::string_view>, 9> prefixes{
      {{9, "G"}, {6, "M"}, {3, "k"}, {0, ""}, {-3, "m"}, {-6, "u"}, {-9, "n"}, {-12, "p"}, {-15, "f"}}};
  const auto text = [digits](double number) {
    const double size = std::abs(number);
    const int whole = size >= 1 && size < 1e6 ? static_cast<int>(std::log10(size)) + 1 : 1;
    std::array<char, 32> buffer;
    std::string shown(buffer.data(), static_cast<std::size_t>(
                                         std::snprintf(buffer.data(), buffer.size(), "%.*g", std::max(digits, whole), number)));
    if (const std::size_t e = shown.find('e'); e != std::string::npos) {  // write 1e-06 as 1e-6
      const std::size_t first = shown.find_first_of("123456789", e);
      shown.replace(e + 1, first - e - 1, shown[e + 1] == '-' ? "-" : "");
    }
    return shown;
  };
  if (unit.empty()) return text(value);
  std::string_view chosen;
  double number = value;
  const std::string_view first = unit.substr(0, unit.find_first_of(" */"));
  const bool takes_prefix = first != "kg" && first != "1" && first != "Vsp" && first != "Vdp" && !first.ends_with('%') &&
                            first.find('^') == std::string_view::npos;
  if (takes_prefix) {
    for (const auto& [exponent, prefix] : prefixes) {
      // A number that rounds up to 1000, such as 999.9999999999, is written with the next prefix.
      const double scaled = value / std::pow(10, exponent), size = std::abs(scaled) * (1 + 1e-12);
      if (size >= 1 && size < 1000) {
        number = scaled;
        chosen = prefix;
      }
    }
  }
  return text(number) + " " + std::string(chosen) + std::string(unit);
}

}  // namespace softland
