#include "base/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <system_error>

#include "base/require.h"
#include "base/trimmed.h"

namespace softland {
namespace {

std::vector<std::string_view> cells(std::string_view line) {
  std::vector<std::string_view> result;
  for (;;) {
    const std::size_t comma = line.find(',');
    result.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return result;
    line.remove_prefix(comma + 1);
  }
}

/// Returns the index of the only column `name` in the header of a CSV file; throws InvalidInput unless there is exactly one.
std::size_t column(const std::vector<std::string_view>& header, std::string_view name, const std::string& place) {
  const auto count = std::count(header.begin(), header.end(), name);
  require(count == 1, [&] {
    return fmt::format("{}: there are {} columns named \"{}\" in the header \"{}\"; there must be one", place, count, name,
                       fmt::join(header, ","));
  });
  return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
}

/// Returns the finite number that the text stands for; none for any other text.
std::optional<double> number(std::string_view text) {
  // from_chars reads every decimal number to the nearest double whatever the locale, but accepts no leading plus.
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

void read_csv(std::string_view content, const std::string& file, const std::vector<std::string>& columns,
              std::string_view expected, const std::function<void(std::span<const double>, const CsvPlace&)>& row) {
  std::vector<std::size_t> at;
  std::size_t width = 0, rows = 0;
  std::vector<double> values(columns.size());
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (content.starts_with(byte_order_mark)) content.remove_prefix(byte_order_mark.size());
  for (int line_number = 1; !content.empty(); ++line_number) {
    const std::size_t line_end = content.find('\n');
    const std::string_view text = trimmed(content.substr(0, line_end));
    content.remove_prefix(line_end == std::string_view::npos ? content.size() : line_end + 1);
    if (text.empty() || text.starts_with('#')) continue;

    // The place (file name and line number) is formatted only for a message, since measured files have many rows.
    const CsvPlace place = [&] { return fmt::format("{}:{}", file, line_number); };
    const std::vector<std::string_view> found = cells(text);
    if (width == 0) {
      for (const std::string& name : columns) at.push_back(column(found, name, place()));
      width = found.size();
      continue;
    }
    require(found.size() == width, [&] {
      return fmt::format("{}: the row has {} cells; it must have {}, as the header has", place(), found.size(), width);
    });
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::optional<double> value = number(found[at[i]]);
      require(value.has_value(),
              [&] { return fmt::format("{}: {} is \"{}\"; it must be a finite number", place(), columns[i], found[at[i]]); });
      values[i] = *value;
    }
    row(values, place);
    ++rows;
  }
  require(width > 0, [&] { return fmt::format("{}: the file has no header; its first line must be {}", file, expected); });
  require(rows > 0, [&] { return fmt::format("{}: the file has a header and no rows; there must be at least one", file); });
}

}  // namespace softland
