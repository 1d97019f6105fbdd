#include "config/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "base/require.h"
#include "base/shortened.h"

namespace softland {
namespace {

struct Symbol {
  std::string_view name;
  Dimension dimension;
  int exponent = 0;  ///< the unit is factor * 10^exponent SI units
  bool takes_prefix = false;
  double factor = 1;  ///< size of the unit divided by the power of ten [SI unit]
};

constexpr std::array symbols{
    Symbol{"m", dimension::length, 0, true},
    Symbol{"cm", dimension::length, -2},
    Symbol{"g", dimension::mass, -3, true},
    Symbol{"s", dimension::time, 0, true},
    Symbol{"A", dimension::current, 0, true},
    Symbol{"K", dimension::temperature, 0, true},
    Symbol{"Pa", dimension::pressure, 0, true},
    Symbol{"hPa", dimension::pressure, 2},
    Symbol{"bar", dimension::pressure, 5, true},
    Symbol{"Torr", dimension::pressure, 0, true, 101325.0 / 760},
    Symbol{"atm", dimension::pressure, 0, false, 101325},
    Symbol{"N", dimension::force, 0, true},
    Symbol{"J", dimension::energy, 0, true},
    Symbol{"W", dimension::power, 0, true},
    Symbol{"V", dimension::voltage, 0, true},
    Symbol{"C", dimension::charge, 0, true},
    Symbol{"F", dimension::capacitance, 0, true},
    Symbol{"ohm", dimension::resistance, 0, true},
    Symbol{"Ohm", dimension::resistance, 0, true},
    Symbol{"S", dimension::conductance, 0, true},
    Symbol{"Hz", dimension::frequency, 0, true},
    Symbol{"rad", dimension::angle, 0, true},
    Symbol{"deg", dimension::angle, 0, false, std::numbers::pi / 180},
    Symbol{"%", dimension::none, -2},
    Symbol{"Vsp", dimension::static_pull_in},
    Symbol{"Vdp", dimension::dynamic_pull_in},
};

struct Prefix {
  char letter;
  int exponent;
};
constexpr std::array prefixes{Prefix{'y', -24}, Prefix{'z', -21}, Prefix{'a', -18}, Prefix{'f', -15},
                              Prefix{'p', -12}, Prefix{'n', -9},  Prefix{'u', -6},  Prefix{'m', -3},
                              Prefix{'k', 3},   Prefix{'M', 6},   Prefix{'G', 9},   Prefix{'T', 12}};

/// A printed character, as used in reports, and the ASCII text that replaces it when a quantity is read.
struct Spelling {
  std::string_view printed;
  std::string_view plain;
};
constexpr std::array spellings{Spelling{"\u00b5", "u"},   // micro sign (U+00B5) becomes u
                               Spelling{"\u03bc", "u"},   // Greek mu (U+03BC) becomes u
                               Spelling{"\u2212", "-"},   // minus sign becomes a hyphen
                               Spelling{"\u00a0", " "},   // no-break space becomes a blank
                               Spelling{"\u202f", " "},   // narrow no-break space becomes a blank
                               Spelling{"\u00b7", "*"},   // middle dot becomes an asterisk
                               Spelling{"\u00b2", "^2"},  // superscripts become powers
                               Spelling{"\u00b3", "^3"}};

std::string plainly_spelt(std::string_view text) {
  std::string plain(text);
  const auto is_ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
  if (std::all_of(plain.begin(), plain.end(), is_ascii)) return plain;  // fast path: there is nothing to replace
  for (const Spelling& spelling : spellings) {
    for (auto at = plain.find(spelling.printed); at != std::string::npos; at = plain.find(spelling.printed, at)) {
      plain.replace(at, spelling.printed.size(), spelling.plain);
    }
  }
  return plain;
}

struct Name {
  Dimension dimension;
  std::string_view what;
  std::string_view unit;
  std::string_view example;
};

constexpr std::array names{
    Name{dimension::none, "a plain number", "", "15 %"},
    Name{dimension::length, "a length", "m", "2 um"},
    Name{dimension::mass, "a mass", "kg", "2.4 ug"},
    Name{dimension::time, "a time", "s", "20 us"},
    Name{dimension::current, "a current", "A", "1 mA"},
    Name{dimension::temperature, "a temperature", "K", "300 K"},
    Name{dimension::angle, "an angle", "rad", "90 deg"},
    Name{dimension::static_pull_in, "a multiple of static pull-in", "Vsp", "1.1 Vsp"},
    Name{dimension::dynamic_pull_in, "a multiple of dynamic pull-in", "Vdp", "1.25 Vdp"},
    Name{dimension::area, "an area", "m^2", "100 um^2"},
    Name{dimension::velocity, "a velocity", "m/s", "0.1 m/s"},
    Name{dimension::area_density, "a number per area", "1/m^2", "100 1/um^2"},
    Name{dimension::density, "a density", "kg/m^3", "19300 kg/m^3"},
    Name{dimension::frequency, "a frequency", "Hz", "30 kHz"},
    Name{dimension::angular_frequency, "an angular frequency", "rad/s", "180543 rad/s"},
    Name{dimension::force, "a force", "N", "1 uN"},
    Name{dimension::energy, "an energy", "J", "1 fJ"},
    Name{dimension::power, "a power", "W", "1 uW"},
    Name{dimension::pressure, "a pressure", "Pa", "78 GPa"},
    Name{dimension::stress_gradient, "a stress gradient, or a stiffness per area", "Pa/m", "0.5 MPa/um"},
    Name{dimension::viscosity, "a viscosity", "Pa s", "1.86e-5 Pa s"},
    Name{dimension::stiffness, "a stiffness", "N/m", "100 N/m"},
    Name{dimension::rotational_stiffness, "a stiffness of rotation", "N m/rad", "1e-7 N m/rad"},
    Name{dimension::slowness, "an inverse velocity", "s/m", "0.3 s/m"},
    Name{dimension::voltage, "a voltage", "V", "45 V"},
    Name{dimension::inverse_voltage, "an inverse voltage", "1/V", "1.6 %/V"},
    Name{dimension::slew_rate, "a slew rate", "V/s", "3 V/us"},
    Name{dimension::charge, "a charge", "C", "1 pC"},
    Name{dimension::capacitance, "a capacitance", "F", "1 pF"},
    Name{dimension::resistance, "a resistance", "ohm", "1 kohm"},
    Name{dimension::resistivity, "a resistivity", "ohm m", "22 nohm m"},
    Name{dimension::conductance, "a conductance", "S", "1 S"},
    Name{dimension::piezo_coefficient, "a piezoelectric coefficient", "m/V", "-171 pm/V"},
    Name{dimension::charge_density, "a piezoelectric stress coefficient, or a charge per area", "C/m^2", "-9.3 C/m^2"},
    Name{dimension::damping, "a damping", "N s/m", "1.3e-5 N s/m"},
};

constexpr std::array<std::string_view, 8> base_units{"m", "kg", "s", "A", "K", "rad", "Vsp", "Vdp"};

const Name* find_name(const Dimension& dimension) {
  for (const Name& name : names) {
    if (name.dimension == dimension) return &name;
  }
  return nullptr;
}

/// The meaning of a unit: value [SI] = number * 10^exponent * factor.
struct UnitScale {
  Dimension dimension;
  int exponent = 0;
  double factor = 1;
};

std::optional<UnitScale> look_up(std::string_view name) {
  for (const Symbol& symbol : symbols) {
    if (name == symbol.name) return UnitScale{symbol.dimension, symbol.exponent, symbol.factor};
  }
  for (const Prefix& prefix : prefixes) {
    if (!name.starts_with(prefix.letter)) continue;
    for (const Symbol& symbol : symbols) {
      if (symbol.takes_prefix && name.substr(1) == symbol.name) {
        return UnitScale{symbol.dimension, symbol.exponent + prefix.exponent, symbol.factor};
      }
    }
  }
  return std::nullopt;
}

/// Returns advice for a unit of wrong case: " (did you mean 'Torr'?)" for "torr". It names the units that differ from `name` in
/// the case of the fewest letters.
std::string in_other_case(std::string_view name) {
  std::size_t least = name.size() + 1;
  std::string near;
  const auto compare = [&](const std::string& unit) {
    std::size_t changed = 0;
    if (unit.size() != name.size()) return;
    for (std::size_t i = 0; i < unit.size(); ++i) {
      if (unit[i] == name[i]) continue;
      const char lower = static_cast<char>(unit[i] | 0x20);
      if (lower < 'a' || lower > 'z' || lower != static_cast<char>(name[i] | 0x20)) return;
      ++changed;
    }
    if (changed > least) return;
    near = (changed < least ? "" : near + " or ") + "'" + unit + "'";
    least = changed;
  };
  for (const Symbol& symbol : symbols) {
    compare(std::string(symbol.name));
    for (const Prefix& prefix : prefixes) {
      if (symbol.takes_prefix) compare(prefix.letter + std::string(symbol.name));
    }
  }
  return near.empty() ? near : fmt::format(" (did you mean {}?)", near);
}

constexpr std::string_view blanks = " \t";

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

constexpr int largest_power = 9;

int parse_power(std::string_view text, std::string_view factor) {
  int power = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), power);
  if (error != std::errc() || end != text.data() + text.size() || power == 0 || std::abs(power) > largest_power) {
    throw InvalidInput(
        fmt::format("'{}' needs an integer power between -{} and {}, not 0", shortened(factor), largest_power, largest_power));
  }
  return power;
}

/// Returns true when a factor of a unit is a length with a digit as its power, such as "m3" for m^3. No symbol of a unit ends
/// with a digit, so that the digit cannot belong to the symbol.
bool has_digit_power(std::string_view factor) {
  if (factor.empty() || factor.back() < '2' || factor.back() > '9') return false;
  const auto unit = look_up(factor.substr(0, factor.size() - 1));
  return unit && unit->dimension == dimension::length;
}

/// Multiplies `scale` by a factor of a unit, such as "um^2" or "um2", if `sign` is 1; divides by it if `sign` is -1.
void apply_factor(UnitScale& scale, std::string_view factor, int sign) {
  const auto caret = factor.find('^');
  const auto end = has_digit_power(factor) ? factor.size() - 1 : caret;
  const std::string_view name = factor.substr(0, end);
  const int power = sign * (end == std::string_view::npos ? 1 : parse_power(factor.substr(caret == end ? end + 1 : end), factor));
  if (name == "degC") throw InvalidInput("'degC' has an offset and can only stand alone; use K here");
  const auto unit = look_up(name);
  if (!unit) throw InvalidInput(fmt::format("unknown unit '{}'{}", shortened(name), in_other_case(name)));
  for (std::size_t i = 0; i < scale.dimension.powers.size(); ++i) {
    scale.dimension.powers[i] += power * unit->dimension.powers[i];
    // Limit the power of a base unit: a quantity may be written in base units, and parse_power() must be able to read them.
    if (std::abs(scale.dimension.powers[i]) > largest_power) {
      throw InvalidInput(fmt::format("with '{}' the power of {} in the unit is {}; it must lie between -{} and {}",
                                     shortened(factor), base_units[i], scale.dimension.powers[i], largest_power, largest_power));
    }
  }
  scale.exponent += power * unit->exponent;
  if (unit->factor != 1) scale.factor *= std::pow(unit->factor, power);
}

/// Multiplies `scale` (`sign` 1) or divides it (`sign` -1) by the factors of a unit, joined by blanks or single asterisks.
void apply_factors(UnitScale& scale, std::string_view text, int sign, std::string_view unit) {
  while (true) {
    const auto star = text.find('*');
    std::string_view group = trim(text.substr(0, star));
    if (group.empty()) throw InvalidInput(fmt::format("a factor is missing in the unit '{}'", unit));
    while (!group.empty()) {
      const auto end = group.find_first_of(blanks);
      apply_factor(scale, group.substr(0, end), sign);
      group = end == std::string_view::npos ? std::string_view{} : trim(group.substr(end));
    }
    if (star == std::string_view::npos) return;
    text.remove_prefix(star + 1);
  }
}

/// Reads S/s, samples per second. S alone is siemens, but no quantity is in siemens per second.
std::optional<UnitScale> sample_rate(std::string_view unit) {
  const auto slash = unit.find('/');
  if (slash == std::string_view::npos || trim(unit.substr(slash + 1)) != "s") return std::nullopt;
  const std::string_view samples = trim(unit.substr(0, slash));
  const auto siemens = samples.ends_with('S') ? look_up(samples) : std::nullopt;
  if (!siemens) return std::nullopt;
  return UnitScale{dimension::frequency, siemens->exponent};
}

UnitScale parse_unit(std::string_view unit) {
  if (const auto rate = sample_rate(unit)) return *rate;
  UnitScale scale;
  const auto slash = unit.find('/');
  if (slash == std::string_view::npos) {
    apply_factors(scale, unit, 1, unit);
    return scale;
  }
  if (unit.find('/', slash + 1) != std::string_view::npos) {
    throw InvalidInput(fmt::format("more than one '/' in the unit '{}'", unit));
  }
  if (trim(unit.substr(0, slash)) != "1") apply_factors(scale, unit.substr(0, slash), 1, unit);
  apply_factors(scale, unit.substr(slash + 1), -1, unit);
  return scale;
}

/// Returns the length of the decimal number at the beginning of `text`; 0 without a number.
std::size_t number_length(std::string_view text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t begin = i;
    while (i < text.size() && text[i] >= '0' && text[i] <= '9') ++i;
    return i - begin;
  };
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
  std::size_t mantissa = digits();
  if (i < text.size() && text[i] == '.') {
    ++i;
    mantissa += digits();
  }
  if (mantissa == 0) return 0;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    const std::size_t mantissa_end = i++;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (digits() == 0) return mantissa_end;
  }
  return i;
}

/// Returns true if a unit may begin with this character directly after a number: "100um" is valid, "2,5 um" and "1_000 um" are
/// not.
bool begins_unit(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%'; }

/// Returns number * 10^exponent, rounded once.
double scaled_number(std::string_view number, int exponent) {
  if (number.starts_with('+')) number.remove_prefix(1);
  const auto e = number.find_first_of("eE");
  const auto out_of_range = [&] {
    return InvalidInput(fmt::format("{} is outside the range of double precision", shortened(number)));
  };
  if (e != std::string_view::npos) {
    std::string_view digits = number.substr(e + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    int own = 0;
    if (std::from_chars(digits.data(), digits.data() + digits.size(), own).ec != std::errc() || std::abs(own) > 9999) {
      throw out_of_range();
    }
    exponent += own;
  }
  const std::string text = fmt::format("{}e{}", number.substr(0, e), exponent);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) throw out_of_range();
  return value;
}

}  // namespace

Quantity parse_quantity(std::string_view given) {
  const std::string plain = plainly_spelt(given);
  const std::string_view text = trim(plain);
  const std::size_t length = number_length(text);
  const std::string_view number = text.substr(0, length);
  const std::string_view unit = trim(text.substr(length));
  if (length == 0 ||
      (length < text.size() && blanks.find(text[length]) == std::string_view::npos && !begins_unit(text[length]))) {
    throw InvalidInput("must be a number and a unit");
  }
  if (unit.empty()) return {scaled_number(number, 0), dimension::none};
  if (unit == "degC") {
    constexpr double zero_celsius = 273.15;  // 0 degrees Celsius [K]
    return {scaled_number(number, 0) + zero_celsius, dimension::temperature};
  }
  const UnitScale scale = parse_unit(unit);
  double value = scaled_number(number, scale.exponent);
  if (scale.factor != 1) value *= scale.factor;
  if (!std::isfinite(value)) throw InvalidInput(fmt::format("{} is outside the range of double precision", text));
  return {value, scale.dimension};
}

std::string unit_symbol(const Dimension& dimension) {
  if (const Name* name = find_name(dimension)) return std::string(name->unit);
  std::string text;
  for (std::size_t i = 0; i < base_units.size(); ++i) {
    const int power = dimension.powers[i];
    if (power == 0) continue;
    if (!text.empty()) text += ' ';
    text += base_units[i];
    if (power != 1) text += fmt::format("^{}", power);
  }
  return text;
}

std::string_view noun(const Dimension& dimension) {
  const Name* name = find_name(dimension);
  return name ? name->what : "a quantity";
}

std::string describe(const Dimension& dimension) {
  const std::string unit = unit_symbol(dimension);
  return unit.empty() ? std::string(noun(dimension)) : fmt::format("{} [{}]", noun(dimension), unit);
}

std::string_view example(const Dimension& dimension) {
  const Name* name = find_name(dimension);
  return name ? name->example : std::string_view{};
}

std::string number_text(double value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string quantity_text(double value, const Dimension& dimension) {
  const std::string unit = unit_symbol(dimension);
  return unit.empty() ? number_text(value) : number_text(value) + " " + unit;
}

std::string percent_text(double value) {
  if (value == 0) return number_text(value) + " %";
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::scientific).ptr;
  const std::string_view text(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
  const auto e = text.find('e');
  int exponent = 0;  // from_chars accepts no plus sign in front
  std::from_chars(text.data() + e + (text[e + 1] == '+' ? 2 : 1), end, exponent);
  const int shift = exponent + 2;  // the point moves to the right by so many digits
  constexpr int most_digits = 15;
  if (shift < 0 || shift > most_digits) return fmt::format("{}e{} %", text.substr(0, e), shift);
  std::string number(text.substr(0, e));
  std::erase(number, '.');
  const std::size_t point = static_cast<std::size_t>(shift) + (number.starts_with('-') ? 2 : 1);
  if (number.size() < point) number.append(point - number.size(), '0');
  if (number.size() > point) number.insert(point, 1, '.');
  return number + " %";
}

}  // namespace softland
