// Reads units as instruments write them in headings of columns: "Time (s)", "C1 in V", "Second", "(mV)", "x/voltage".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace softland::internal {

enum class Measure { time, voltage, frequency, samples, level, other };  // quantity that a unit measures; level: in decibels

struct Unit {
  Measure measure = Measure::other;
  std::string symbol;  ///< symbol of the unit, such as "s" or "mV"; the text itself if the unit is not known
  double per_si = 1;   ///< number of this unit in one SI unit: 1000 for ms
  [[nodiscard]] double in_si(double value) const { return value / per_si; }
};

/// Returns the unit that a text means, with or without brackets; none for an unknown unit.
[[nodiscard]] std::optional<Unit> unit_of(std::string_view text);

struct Heading {
  std::string name;
  std::optional<Unit> unit;
};
/// Splits the heading of a column into its name and its unit.
[[nodiscard]] Heading heading_of(std::string_view text);

/// A number with its unit, if any.
struct Measured {
  double value = 0;         ///< number as written, in its unit
  std::string_view number;  ///< text of the number without its unit
  std::optional<Unit> unit = {};
  [[nodiscard]] double si() const { return unit ? unit->in_si(value) : value; }
};
/// Reads a number with or without a unit, such as "160000Hz", "8 ns" or "5"; none if the text has no number, or an unknown
/// unit.
[[nodiscard]] std::optional<Measured> measured(std::string_view text);
/// Reads the value of a setting above the numbers of a file. The value may begin with the name of a channel ("CH1:2e-06"), but
/// must not be a time of day. `unit` is the unit in the name of the setting, as in "Sample interval (us)".
[[nodiscard]] std::optional<Measured> measured_value(std::string_view text, const std::optional<Unit>& unit);

/// Returns true for a unit that instruments write beside numbers in cells, as in "5.0 V" or "-52.43 us".
[[nodiscard]] bool is_unit_of_cells(const std::optional<Unit>& unit);
/// Reads a cell that holds a number with a unit; none for any other cell.
[[nodiscard]] std::optional<Measured> measured_cell(std::string_view cell);

}  // namespace softland::internal
