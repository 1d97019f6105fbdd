#include "reports/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace softland::internal {
namespace {

constexpr std::array prefixes{Prefix{1e-24, "y"}, Prefix{1e-21, "z"}, Prefix{1e-18, "a"}, Prefix{1e-15, "f"}, Prefix{1e-12, "p"},
                              Prefix{1e-9, "n"},  Prefix{1e-6, "µ"},  Prefix{1e-3, "m"},  Prefix{1.0, ""},    Prefix{1e3, "k"},
                              Prefix{1e6, "M"},   Prefix{1e9, "G"},   Prefix{1e12, "T"}};

/// `value` rounded to `digits` significant digits, still a double.
double rounded(double value, int digits) { return std::strtod(fmt::format("{:.{}e}", value, digits - 1).c_str(), nullptr); }

}  // namespace

Prefix prefix_for(double largest) {
  const double size = std::abs(largest);
  if (!std::isfinite(size) || size == 0) return {};
  Prefix chosen = prefixes.front();
  for (const Prefix& prefix : prefixes) {
    if (size >= prefix.factor * (1 - 1e-12)) chosen = prefix;
  }
  return chosen;
}

std::string quantity(double value, std::string_view unit, int digits) {
  constexpr const char* no_break_space = "\u00a0";
  if (!std::isfinite(value)) return "—";
  if (unit.empty()) return plain_number(value, digits);
  if (value == 0) return fmt::format("0{}{}", no_break_space, unit);
  const double shown = rounded(value, digits);  // first, so that 999.96 becomes 1.00 k and not 1000
  const Prefix prefix = prefix_for(shown);
  const double number = shown / prefix.factor;
  const int whole_digits = number != 0 ? static_cast<int>(std::floor(std::log10(std::abs(number)) + 1e-9)) + 1 : 1;
  const int decimals = std::max(0, digits - whole_digits);
  return fmt::format("{:.{}f}{}{}{}", number, decimals, no_break_space, prefix.symbol, unit);
}

std::string quantity_beside(double value, double neighbour, std::string_view unit, int digits) {
  if (value != 0 || unit.empty() || !std::isfinite(neighbour)) return quantity(value, unit, digits);
  return fmt::format("0\u00a0{}{}", prefix_for(neighbour).symbol, unit);
}

std::string plain_number(double value, int digits) {
  if (!std::isfinite(value)) return "—";
  const double size = std::abs(value);
  if (size >= 1 && size < 1e6) {  // 2500 stays 2500 however few digits are asked for
    const int whole_digits = static_cast<int>(std::floor(std::log10(size) + 1e-9)) + 1;
    return fmt::format("{:.{}g}", value, std::max(digits, whole_digits));
  }
  return fmt::format("{:.{}g}", value, digits);
}

}  // namespace softland::internal
