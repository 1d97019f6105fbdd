// Units as instruments write them beside names of columns: "Time (s)", "C1 in V", "Second", "(mV)", "x/voltage".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace softland::internal {

enum class Measure { time, voltage, frequency, samples, level, other };  // level: decibels

struct Unit {
  Measure measure = Measure::other;
  std::string symbol;  ///< "s", "mV"; the text itself where it is not known
  double per_si = 1;   ///< how many of it are one SI unit: 1000 of ms
  [[nodiscard]] double in_si(double value) const { return value / per_si; }
};

/// The unit that a text names, in brackets or not; nothing where it is not known.
[[nodiscard]] std::optional<Unit> unit_of(std::string_view text);

struct Heading {
  std::string name;
  std::optional<Unit> unit;
};
/// Name and unit of a column of which the heading is known.
[[nodiscard]] Heading heading_of(std::string_view text);

/// A number and what follows it, "160000Hz", "8 ns", "CH1:2e-06", in SI units where the unit is known; nothing where there is no
/// number. A unit that is given by the key of the number, "Sample interval (us)", comes in `unit`.
[[nodiscard]] std::optional<double> measured_value(std::string_view text, const std::optional<Unit>& unit = {});

}  // namespace softland::internal
