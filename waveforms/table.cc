#include "waveforms/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/read_file.h"
#include "base/require.h"

namespace softland {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const std::size_t begin = text.find_first_not_of(blank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blank) - begin + 1);
}

std::vector<std::string_view> cells(std::string_view line) {
  std::vector<std::string_view> result;
  for (;;) {
    const std::size_t comma = line.find(',');
    result.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return result;
    line.remove_prefix(comma + 1);
  }
}

/// The column of `name`, which must be there exactly once.
std::size_t column(const std::vector<std::string_view>& header, std::string_view name, const std::string& place) {
  const auto count = std::count(header.begin(), header.end(), name);
  require(count == 1, fmt::format("{}: there are {} columns named \"{}\" in the header \"{}\"; there must be one", place, count,
                                  name, fmt::join(header, ",")));
  return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
}

/// A finite number, or nothing.
std::optional<double> number(std::string_view text) {
  // from_chars reads every decimal number to the nearest double whatever the locale, but knows no leading plus.
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

Signal signal(const Table& table) {
  const std::size_t count = table.time.size();
  require(count == table.voltage.size(),
          fmt::format("a table has {} times and {} voltages; there must be as many of both", count, table.voltage.size()));
  require(count >= 1, "a table has no rows; there must be at least one");
  require(table.time.front() == 0, fmt::format("the time of the first row of a table is {} s; it must be 0", table.time.front()));
  std::vector<std::pair<double, double>> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(std::isfinite(table.time[i]) && (i == 0 || table.time[i] >= table.time[i - 1]))) {
      throw InvalidInput(fmt::format("the time of row {} of a table is {} s; it must be finite and not before the row above",
                                     i + 1, table.time[i]));
    }
    if (!std::isfinite(table.voltage[i])) {
      throw InvalidInput(fmt::format("the voltage of row {} of a table is {} V; it must be finite", i + 1, table.voltage[i]));
    }
    points.emplace_back(table.time[i], table.voltage[i]);
  }
  return Signal::piecewise_linear(points);
}

Table read_table(const std::string& file, const std::string& drive) { return parse_table(read_file(file), file, drive); }

Table parse_table(std::string_view content, const std::string& file, const std::string& drive) {
  Table table;
  std::size_t time_column = 0;
  std::size_t drive_column = 0;
  std::size_t columns = 0;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (content.starts_with(byte_order_mark)) content.remove_prefix(byte_order_mark.size());
  for (int line_number = 1; !content.empty(); ++line_number) {
    const std::size_t line_end = content.find('\n');
    const std::string_view text = trimmed(content.substr(0, line_end));
    content.remove_prefix(line_end == std::string_view::npos ? content.size() : line_end + 1);
    if (text.empty() || text.starts_with('#')) continue;

    // Measured files are long: a message, and the place in it, is composed only when a row is refused.
    const auto place = [&] { return fmt::format("{}:{}", file, line_number); };
    const std::vector<std::string_view> row = cells(text);
    if (columns == 0) {
      time_column = column(row, "time_s", place());
      drive_column = column(row, drive, place());
      columns = row.size();
      continue;
    }
    if (row.size() != columns) {
      throw InvalidInput(fmt::format("{}: the row has {} cells; it must have {} as the header", place(), row.size(), columns));
    }
    const auto cell = [&](std::size_t at, std::string_view name) {
      const std::optional<double> value = number(row[at]);
      if (!value) throw InvalidInput(fmt::format("{}: {} is \"{}\"; it must be a finite number", place(), name, row[at]));
      return *value;
    };
    const double time = cell(time_column, "time_s");
    if (table.time.empty() && time != 0) {
      throw InvalidInput(fmt::format("{}: the first time_s is {} s; it must be 0", place(), time));
    }
    if (!table.time.empty() && time < table.time.back()) {
      throw InvalidInput(
          fmt::format("{}: time_s is {} s; it must not be before the {} s of the row above", place(), time, table.time.back()));
    }
    const double voltage = cell(drive_column, drive);
    if (!table.time.empty() && time > table.time.back() &&
        !std::isfinite((voltage - table.voltage.back()) / (time - table.time.back()))) {
      throw InvalidInput(
          fmt::format("{}: {} is {} V, {} s after the {} V of the row above; the slope between them must be finite", place(),
                      drive, voltage, time - table.time.back(), table.voltage.back()));
    }
    table.time.push_back(time);
    table.voltage.push_back(voltage);
  }
  require(columns > 0, fmt::format("{}: the file has no header; its first line must be time_s and one column per drive", file));
  require(!table.time.empty(), fmt::format("{}: the file has a header and no rows; there must be at least one", file));
  return table;
}

}  // namespace softland
