#include "document/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

namespace softland::internal {
namespace {

constexpr std::array prefixes{Prefix{1e-24, "y"}, Prefix{1e-21, "z"}, Prefix{1e-18, "a"}, Prefix{1e-15, "f"}, Prefix{1e-12, "p"},
                              Prefix{1e-9, "n"},  Prefix{1e-6, "µ"},  Prefix{1e-3, "m"},  Prefix{1.0, ""},    Prefix{1e3, "k"},
                              Prefix{1e6, "M"},   Prefix{1e9, "G"},   Prefix{1e12, "T"}};

constexpr double beyond_prefixes = 1e15;

constexpr const char* no_break_space = "\u00a0";
constexpr const char* none = "—";
constexpr double most_times = 1000;
// Largest ratio that is shown in percent: 10, which is a thousand per cent; larger ratios are shown as factors.
constexpr double most_percent = 10;

/// Returns the decimal exponent of the first digit of a value that is not 0; for an infinite value, the exponent of the largest
/// double.
int exponent_of(double value) {
  const double size = std::min(std::abs(value), std::numeric_limits<double>::max());
  return static_cast<int>(std::floor(std::log10(size) + 1e-12));
}

/// Rounds `value` to a multiple of 10^place.
double rounded(double value, int place) {
  if (value == 0) return 0;
  const int digits = exponent_of(value) - place;  // number of shown digits after the first digit
  if (digits < -1) return 0;
  if (digits < 0) return std::abs(value) < 0.5 * std::pow(10, place) ? 0 : std::copysign(std::pow(10, place), value);
  const double near = std::strtod(fmt::format("{:.{}e}", value, digits).c_str(), nullptr);
  return std::isfinite(near) ? near : value;
}

/// Returns the smallest multiple of 10^place that is at least `error`, so that a rounded error still covers the error.
double rounded_up(double error, int place) {
  const double last = std::pow(10, place);
  if (last == 0) return error;  // 10^place underflows to 0
  return std::min(std::ceil(error / last * (1 - 1e-9)) * last, std::numeric_limits<double>::max());
}

/// Returns the decimal place of the last shown digit of an error: its first digit, or the second if the first is 1.
int place_of_error(double error) {
  const int exponent = exponent_of(rounded(error, exponent_of(error) - 1));
  return std::abs(error) < 1.95 * std::pow(10, exponent) ? exponent - 1 : exponent;
}

/// Returns the decimal place of the last shown digit of a value: the coarsest of the places that the number of digits, the
/// resolution of the unit and the error permit.
int last_place(double value, double error, std::string_view unit, int digits) {
  int place = -400;
  if (value != 0) place = exponent_of(value) - digits + 1;
  if (const double least = resolution(unit); least > 0) place = std::max(place, exponent_of(least));
  if (error > 0 && std::isfinite(error)) place = std::max(place, place_of_error(error));
  return place;
}

/// Formats `value` [unit] with the SI prefix `prefix`; 10^place is the decimal place of its last digit.
std::string in_prefix(double value, int place, Prefix prefix, std::string_view unit) {
  const double size = std::abs(value);
  if (size >= beyond_prefixes || (size > 0 && size < prefixes.front().factor))
    return scientific(value, std::max(1, exponent_of(value) - place + 1)) +
           (unit.empty() ? "" : no_break_space + std::string(unit));
  const int decimals = std::max(0, exponent_of(prefix.factor) - place);
  return with_true_minus(fmt::format("{:.{}f}", value == 0 ? 0.0 : value / prefix.factor, value == 0 ? 0 : decimals)) +
         (unit.empty() ? "" : fmt::format("{}{}{}", no_break_space, prefix.symbol, unit));
}

/// A rounded value with the decimal place of its last digit and its SI prefix.
struct Shown {
  double value = 0;
  int place = 0;
  Prefix prefix;
};

Shown shown(double value, double error, std::string_view unit, int digits) {
  // Round before choosing the prefix: 999.96 becomes 1.00 k, not 1000.
  Shown s{.value = rounded(value, last_place(value, error, unit, digits))};
  s.place = last_place(s.value != 0 ? s.value : value, error, unit, digits);
  if (unit.empty()) return s;
  // Choose the SI prefix by the error of a value if the error is larger than the value.
  const double beside = error > 0 && std::isfinite(error) ? rounded_up(error, s.place) : 0;
  s.prefix = prefix_for(std::max(std::abs(s.value), beside));
  return s;
}

std::string without_trailing_zeros(std::string number) {
  if (number.find('.') == std::string::npos || number.find('e') != std::string::npos) return number;
  number.erase(number.find_last_not_of('0') + 1);
  if (number.ends_with('.')) number.pop_back();
  return number;
}

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

std::string with_true_minus(const std::string& number) { return number.starts_with('-') ? "−" + number.substr(1) : number; }

bool takes_prefix(std::string_view unit) {
  constexpr std::array<std::string_view, 20> with{"m",   "s",   "V", "N", "J", "Pa", "Hz", "rad/s", "m/s", "V/s",
                                                  "N/m", "m/V", "A", "W", "F", "C",  "K",  "ohm",   "H",   "Pa s"};
  return std::find(with.begin(), with.end(), unit) != with.end();
}

double resolution(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 8> least{
      {{"m", 1e-12}, {"s", 1e-15}, {"m/s", 1e-9}, {"N", 1e-15}, {"J", 1e-21}, {"V", 1e-6}, {"V/s", 1}, {"V/µs", 1e-6}}};
  const auto* const found = std::find_if(least.begin(), least.end(), [&](const auto& one) { return one.first == unit; });
  return found == least.end() ? 0 : found->second;
}

std::string quantity(double value, std::string_view unit, int digits) {
  return quantity_within(value, std::numeric_limits<double>::quiet_NaN(), unit, digits);
}

namespace {

/// Returns true for a slew rate from 1 kV/s on, which is shown in volts per microsecond.
bool is_fast(double size, std::string_view unit) {
  constexpr double fast = 1e3;
  return unit == "V/s" && std::isfinite(size) && std::abs(size) >= fast;
}
constexpr double per_microsecond = 1e-6;
constexpr std::string_view fast_slew = "V/µs";

}  // namespace

std::string quantity_beside(double value, double neighbour, std::string_view unit, int digits) {
  if (value != 0 || unit.empty() || !std::isfinite(neighbour)) return quantity(value, unit, digits);
  if (is_fast(neighbour, unit)) return quantity_beside(value, per_microsecond * neighbour, fast_slew, digits);
  return fmt::format("0{}{}{}", no_break_space, prefix_for(rounded(neighbour, last_place(neighbour, 0, unit, digits))).symbol,
                     unit);
}

std::string quantity_within(double value, double error, std::string_view unit, int digits) {
  if (!std::isfinite(value)) return none;
  if (is_fast(value, unit)) return quantity_within(per_microsecond * value, per_microsecond * error, fast_slew, digits);
  const double least = resolution(unit);
  const bool known = !(error >= least);  // true if the error is below the resolution of the unit, or unknown (NaN)
  if (known && value > 0 && value < least) return "< " + quantity(least, unit, 1);
  const Shown s = shown(value, error, unit, digits);
  if (unit.empty() && !(error > 0)) return plain_number(value, digits);
  return in_prefix(s.value, s.place, s.prefix, unit);
}

std::string error_of(double value, double error, std::string_view unit, int digits) {
  if (!std::isfinite(value) || !std::isfinite(error)) return none;
  if (error == 0) return quantity_beside(0, value, unit);
  if (is_fast(value, unit)) return error_of(per_microsecond * value, per_microsecond * error, fast_slew, digits);
  const Shown s = shown(value, error, unit, digits);
  return (error < std::pow(10, s.place) / 2 ? "< " : "") + in_prefix(rounded_up(error, s.place), s.place, s.prefix, unit);
}

std::string given_quantity(double value, std::string_view unit, int digits) {
  std::string text = quantity(value, unit, digits);
  const std::size_t end = text.find(no_break_space);
  if (end == std::string::npos || text.starts_with('<')) return text;
  return without_trailing_zeros(text.substr(0, end)) + text.substr(end);
}

std::string plain_number(double value, int digits) {
  if (!std::isfinite(value)) return none;
  const double size = std::abs(value);
  if (size != 0 && (size < 1e-4 || size >= 1e6)) return scientific(value, digits);
  // All digits before the decimal point are shown: 2500 remains 2500 even if fewer digits are requested.
  const int whole_digits = size >= 1 ? exponent_of(size) + 1 : 1;
  return with_true_minus(fmt::format("{:.{}g}", value == 0 ? 0.0 : value, std::max(digits, whole_digits)));
}

std::string whole(double count) {
  if (!std::isfinite(count)) return none;
  return std::abs(count) < beyond_prefixes ? with_true_minus(fmt::format("{:.0f}", count)) : scientific(count);
}

std::string scientific(double value, int digits) {
  if (!std::isfinite(value)) return none;
  const std::string text = fmt::format("{:.{}e}", value, digits - 1);
  const std::size_t mark = text.find('e');
  return with_true_minus(without_trailing_zeros(text.substr(0, mark))) + "e" +
         std::to_string(std::strtol(text.c_str() + mark + 1, nullptr, 10));
}

std::string relative_error(double value) {
  constexpr double least = 1e-9;
  if (value == 0) return "0";
  return value < least ? "< " + scientific(least) : scientific(value);
}

std::string times(double ratio) {
  if (!std::isfinite(ratio)) return none;
  if (ratio > most_times) return fmt::format("more than {:.0f} times", most_times);
  return (ratio < 9.95 ? fmt::format("{:.1f}", ratio) : fmt::format("{:.0f}", ratio)) + " times";
}

std::string percent(double ratio) {
  if (!std::isfinite(ratio)) return none;
  return ratio > most_percent ? times(ratio) : fmt::format("{:.{}f} %", 100 * ratio, ratio < 1 ? 1 : 0);
}

std::string share_text(double share) { return std::isfinite(share) ? share_number(share) + " %" : none; }

std::string share_number(double share) {
  constexpr double rounding = 1e-12;  // error of a share that is computed as a sum or a difference
  if (!std::isfinite(share)) return none;
  if (share >= 1 - rounding) return "100";
  if (share <= rounding) return "0.0";
  const std::string number = fmt::format("{:.1f}", 100 * share);
  return number == "100.0" ? "> 99.9" : number == "0.0" ? "< 0.1" : number;
}

std::string relative_change(double change) {
  if (!std::isfinite(change)) return none;
  if (1 + change > most_times) return fmt::format("> × {:.0f}", most_times);
  if (change > most_percent) return fmt::format("× {:.0f}", 1 + change);
  const std::string size = percent(std::abs(change));
  return size == "0.0 %" ? size : (change < 0 ? "−" : "+") + size;
}

}  // namespace softland::internal
