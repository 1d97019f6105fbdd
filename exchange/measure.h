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
  double per_si = 1;   ///< number of these units that make one SI unit: 1000 of ms
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

/// A number with the unit that stands behind it, where there is one.
struct Measured {
  double value = 0;         ///< value as written
  std::string_view number;  ///< the text of it
  std::optional<Unit> unit = {};
  [[nodiscard]] double si() const { return unit ? unit->in_si(value) : value; }
};
/// Reads "160000Hz", "8 ns", "5"; nothing if the text has no number, or an unknown unit behind it.
[[nodiscard]] std::optional<Measured> measured(std::string_view text);
/// The same of a value in a preamble, which may have the name of a channel before it, "CH1:2e-06", but is no time of the day. A
/// unit that is given by the key of the number, "Sample interval (us)", comes in `unit`.
[[nodiscard]] std::optional<Measured> measured_value(std::string_view text, const std::optional<Unit>& unit);

/// True if a unit is one that stands beside numbers in cells: "5.0 V", "-52.43 us".
[[nodiscard]] bool is_unit_of_cells(const std::optional<Unit>& unit);
/// A cell that is a number with such a unit; nothing for any other.
[[nodiscard]] std::optional<Measured> measured_cell(std::string_view cell);

}  // namespace softland::internal
