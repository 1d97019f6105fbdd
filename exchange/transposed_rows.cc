#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "base/trimmed.h"
#include "exchange/block.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"

namespace softland::internal {
namespace {

/// The rows of a file in which each row holds all numbers of one channel: `rows` are their cells, `places` their lines in the
/// file, and `above` the lines before the row of the first channel.
struct LyingRows {
  std::vector<Line> above, places;
  std::vector<CellList> rows;
  std::size_t width = 0;  ///< number of values in the longest row of a channel
  bool named = false;     ///< true if every row of a channel begins with a name
  char separator = ',';
};

// Returns the lines of a text that are not blank; none if they are more than 64, the most of a file with one channel per row.
std::vector<Line> few_lines(std::string_view text, const ReadKeys& keys, bool& ends_unended) {
  constexpr std::size_t most = 64;
  std::vector<Line> all;
  Lines lines(text);
  while (lines.next()) {
    ends_unended = lines.is_unended();
    if (lines.number() <= static_cast<std::size_t>(keys.skip) || trimmed(lines.line()).empty()) continue;
    all.push_back({lines.line(), lines.number()});
    if (all.size() > most) return {};
  }
  return all;
}

LyingRows rows_in(const std::vector<Line>& all) {
  constexpr std::size_t fewest_numbers = 3;
  LyingRows found{.separator = separator_of(all)};
  for (const Line& line : all) {
    CellList cells;
    split_cells(line.text, found.separator, cells);
    while (!cells.empty() && cells.back().empty()) cells.pop_back();
    const bool has_name = !cells.empty() && !looks_like_number(cells.front());
    const std::size_t numbers = cells.size() - (has_name ? 1 : 0);
    if (found.rows.empty() && numbers_in(cells) < std::max(fewest_numbers, numbers)) {
      found.above.push_back(line);
      continue;
    }
    found.rows.push_back(cells);
    found.places.push_back(line);
    found.width = std::max(found.width, numbers);
  }
  found.named = !found.rows.empty() && std::all_of(found.rows.begin(), found.rows.end(), [](const CellList& cells) {
    return !cells.empty() && !cells.front().empty() && std::isalpha(static_cast<unsigned char>(cells.front().front())) != 0;
  });
  return found;
}

// Returns true if each row is likely a channel, not a sample of all channels: rows begin with names, or they are long and there
// are no column names above them.
bool are_channels(const LyingRows& found) {
  constexpr std::size_t fewest_named = 3, fewest_unnamed = 16;
  if (found.rows.size() < 2) return false;
  if (found.named) return found.width >= fewest_named;
  if (found.width < std::max(fewest_unnamed, 4 * found.rows.size())) return false;
  return std::none_of(found.above.begin(), found.above.end(), [&](const Line& line) {
    CellList cells;
    split_cells(line.text, found.separator, cells);
    return cells.size() >= found.width;
  });
}

std::vector<double> numbers_of(const CellList& row, bool named, const Line& place, DecimalSign& decimal,
                               const Refusals& refusals) {
  std::vector<double> values;
  for (std::size_t i = named ? 1 : 0; i < row.size(); ++i) {
    const Cell cell = read_cell(row[i], decimal);
    if (cell.kind != CellKind::number)
      refusals.fail(place.number, i + 1, fmt::format("is \"{}\"; it must be a finite number", shown_cell(row[i])));
    values.push_back(cell.value);
  }
  return values;
}

}  // namespace

std::optional<Block> read_lying_rows(std::string_view text, const Refusals& refusals, const ReadKeys& keys) {
  bool ends_unended = false;
  const LyingRows found = rows_in(few_lines(text, keys, ends_unended));
  if (!are_channels(found)) return std::nullopt;
  Block block;
  for (const Line& line : found.above) {
    CellList cells;
    split_cells(line.text, found.separator, cells);
    block.preamble.take_line(line.text, cells);
  }
  DecimalSign decimal{.sign = keys.decimal, .is_given = keys.decimal != '\0'};
  block.has_headings = found.named;
  for (std::size_t r = 0; r < found.rows.size(); ++r) {
    const CellList& row = found.rows[r];
    block.columns.push_back(static_cast<int>(r + 1));
    block.names.emplace_back(found.named ? row.front() : std::string_view());
    block.units.emplace_back();
    block.missing.emplace_back();
    block.digits.push_back(significant_digits(row.back()));
    block.values.push_back(numbers_of(row, found.named, found.places[r], decimal, refusals));
    const std::size_t count = block.values.back().size();
    if (count != found.width)
      refusals.fail(
          found.places[r].number, 0,
          fmt::format("the row has {} numbers, and the longest row has {}; rows that are channels must have equal lengths", count,
                      found.width));
  }
  if (ends_unended) block.notes.emplace_back(may_be_cut);
  block.lines.assign(found.width, static_cast<std::uint32_t>(found.places.front().number));
  return block;
}

}  // namespace softland::internal
