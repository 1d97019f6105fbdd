#include "waveforms/table.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string_view>

#include "base/csv.h"
#include "base/read_file.h"
#include "base/require.h"

namespace softland {

Signal signal(const Table& table, double before) {
  const std::size_t count = table.time.size();
  require(
      count == table.voltage.size(),
      fmt::format("a table has {} times and {} voltages; it must have as many times as voltages", count, table.voltage.size()));
  require(count >= 1, "a table must have at least one row");
  require(table.time.front() == 0, fmt::format("the time of the first row of a table is {} s; it must be 0", table.time.front()));
  for (std::size_t i = 0; i < count; ++i) {
    if (!(std::isfinite(table.time[i]) && (i == 0 || table.time[i] >= table.time[i - 1]))) {
      throw InvalidInput(fmt::format("the time of row {} of a table is {} s; it must be finite and not before the row above",
                                     i + 1, table.time[i]));
    }
    if (!std::isfinite(table.voltage[i])) {
      throw InvalidInput(fmt::format("the voltage of row {} of a table is {} V; it must be finite", i + 1, table.voltage[i]));
    }
  }
  return Signal::piecewise_linear(points(table), before);
}

Table read_table(const std::string& file, const std::string& drive) { return parse_table(read_file(file), file, drive); }

Table parse_table(std::string_view content, const std::string& file, const std::string& drive) {
  Table table;
  read_csv(content, file, {"time_s", drive}, "time_s and one column per drive",
           [&](std::span<const double> row, const CsvPlace& place) {
             const double time = row[0], voltage = row[1];
             if (table.time.empty()) {
               require(time == 0, [&] { return fmt::format("{}: the first time_s is {} s; it must be 0", place(), time); });
             } else {
               const double before = table.time.back(), from = table.voltage.back();
               require(time >= before, [&] {
                 return fmt::format("{}: time_s is {} s; it must not be before the {} s of the row above", place(), time, before);
               });
               require(!(time > before) || std::isfinite((voltage - from) / (time - before)), [&] {
                 return fmt::format(
                     "{}: {} is {} V, {} s after the {} V of the row above; "
                     "the slope between them must be finite",
                     place(), drive, voltage, time - before, from);
               });
             }
             table.time.push_back(time);
             table.voltage.push_back(voltage);
           });
  return table;
}

}  // namespace softland
