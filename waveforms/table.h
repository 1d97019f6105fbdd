// Table waveform: measured or exported voltages, linear between the rows of a table; the last voltage is held. Two rows of
// equal time are a jump.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

template <class P>
struct TableOf {
  std::vector<P> time = {};     ///< time of each row of the table [s], from 0 on, not decreasing
  std::vector<P> voltage = {};  ///< voltage of each row of the table [V]
};
using Table = TableOf<double>;

template <>
struct FamilyOf<Table> {
  static constexpr std::string_view name = "table";
  static constexpr bool from_file = true;
  static constexpr auto parameters = std::to_array<Parameter<Table>>({
      {"times", ParameterKind::time, &Table::time, true,
       "times of the rows, from 0 s on, not decreasing; two rows of one time are a jump"},
      {"voltages", ParameterKind::level, &Table::voltage, true,
       "voltages of the rows, as many as times, linear between them; the last is held"},
  });
  [[nodiscard]] static Table example() { return {.time = {0, 1, 1, 2}, .voltage = {1, 2, 3, -1}}; }
};

/// Returns the points (time [s], voltage [V]) that straight lines connect, for a valid table.
template <class P>
[[nodiscard]] std::vector<std::pair<P, P>> points(const TableOf<P>& table) {
  std::vector<std::pair<P, P>> all;
  all.reserve(table.time.size());
  for (std::size_t i = 0; i < table.time.size(); ++i) all.emplace_back(table.time[i], table.voltage[i]);
  return all;
}
template <class P>
[[nodiscard]] Pieces<P> pieces(const TableOf<P>& table) {
  return internal::straight_pieces(points(table));
}
/// Compiles the table to a voltage signal. Throws InvalidInput for an invalid table.
[[nodiscard]] Signal signal(const Table& table, double before = 0);

/// Reads the voltage of the drive `drive` from a CSV file with a header line: `time_s` and one column per drive [V]. Throws
/// InvalidInput with file, line and rule.
[[nodiscard]] Table read_table(const std::string& file, const std::string& drive);

/// Reads the voltage of a drive from the content of a CSV file as read_table() does; `file` is its name in messages.
[[nodiscard]] Table parse_table(std::string_view content, const std::string& file, const std::string& drive);

}  // namespace softland
