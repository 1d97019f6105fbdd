#include "exchange/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>

#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"
#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/measure.h"

namespace softland::internal {

void Refusals::fail(std::size_t line, std::size_t column, const std::string& rule) const {
  throw InvalidInput(column == 0 ? fmt::format("{}:{}: {}", file_, line, rule)
                                 : fmt::format("{}:{}: column {}: {}", file_, line, column, rule));
}

void Refusals::fail(const std::string& rule) const { throw InvalidInput(fmt::format("{}: {}", file_, rule)); }

std::string shown_cell(std::string_view cell) { return printable_line(shortened(cell, 40)); }

void split_row(std::string_view line, char separator, CellList& cells) {
  split_cells(line, separator, cells);
  if (separator != ' ') return;
  std::size_t kept = 0;
  for (const std::string_view cell : cells) {
    const bool may_be_unit = kept > 0 && cell.find_first_of("+-.,0123456789") != 0;
    if (may_be_unit && looks_like_number(cells[kept - 1]) && is_unit_of_cells(unit_of(cell))) {
      const char* const first = cells[kept - 1].data();
      cells[kept - 1] = {first, static_cast<std::size_t>(cell.data() + cell.size() - first)};
    } else {
      cells[kept++] = cell;
    }
  }
  cells.resize(kept);
}

bool is_blank(const CellList& cells) {
  return std::all_of(cells.begin(), cells.end(), [](std::string_view cell) { return cell.empty(); });
}

bool holds_number(std::string_view cell) { return looks_like_number(cell) || measured_cell(cell); }

bool may_be_value(std::string_view cell) {
  DecimalSign any;
  const CellKind kind = read_cell(cell, any).kind;
  return kind == CellKind::blank || kind == CellKind::not_finite || holds_number(cell);
}

std::size_t numbers_in(const CellList& cells) {
  return static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), holds_number));
}

std::vector<Line> last_lines(std::string_view text, std::size_t skip) {
  constexpr std::size_t enough = 13, end_of_long_text = 1 << 20;
  if (skip == 0 && text.size() > 2 * end_of_long_text) {
    const std::size_t line_end = text.find_last_of("\r\n", text.size() - end_of_long_text);
    const std::vector<Line> last =
        line_end == std::string_view::npos ? std::vector<Line>() : last_lines(text.substr(line_end + 1), 0);
    if (last.size() == enough) return last;
  }
  std::deque<Line> kept;
  Lines lines(text);
  bool unended = false;
  while (lines.next()) {
    if (lines.number() <= skip || trimmed(lines.line()).empty()) continue;
    kept.push_back({lines.line(), lines.number()});
    if (kept.size() > enough) kept.pop_front();
    unended = lines.is_unended();
  }
  std::vector<Line> last(kept.rbegin(), kept.rend());
  if (unended && last.size() > 1) std::rotate(last.begin(), last.begin() + 1, last.end());
  return last;
}

char separator_of(const std::vector<Line>& lines) {
  constexpr std::array separators{'\t', ';', ',', ' '};
  CellList cells;
  for (const bool alone : {true, false}) {
    for (const char separator : separators) {
      std::size_t fitting = 0;
      for (const Line& line : lines) {
        split_row(line.text, separator, cells);
        const std::size_t numbers = numbers_in(cells);
        const bool all = std::all_of(cells.begin(), cells.end(), may_be_value);
        fitting += cells.size() > 1 && numbers > 0 && (all || !alone);
      }
      if (2 * fitting > lines.size()) return separator;
    }
  }
  return ',';
}

std::vector<bool> numeric_columns(const std::vector<Line>& last, char separator) {
  std::vector<bool> is_numeric;
  for (const bool without_prose : {true, false}) {
    std::vector<int> excess;  // for each column, number of cells with a number minus number of missing cells and of words
    CellList cells;
    int lines = 0;
    for (const Line& line : last) {
      split_row(line.text, separator, cells);
      if (numbers_in(cells) == 0) break;
      if (excess.size() < cells.size()) excess.resize(cells.size(), -lines);
      const bool counts = !without_prose || std::all_of(cells.begin(), cells.end(), may_be_value);
      for (std::size_t i = 0; i < excess.size(); ++i) {
        DecimalSign any;
        CellKind kind = i < cells.size() ? read_cell(cells[i], any).kind : CellKind::no_number;
        if (kind == CellKind::no_number && i < cells.size() && measured_cell(cells[i])) kind = CellKind::number;
        if (kind == CellKind::no_number) --excess[i];
        if (counts && (kind == CellKind::number || kind == CellKind::not_finite)) ++excess[i];
      }
      ++lines;
    }
    is_numeric.clear();
    for (const int one : excess) is_numeric.push_back(one > 0);
    while (!is_numeric.empty() && !is_numeric.back()) is_numeric.pop_back();
    if (!is_numeric.empty()) break;
  }
  return is_numeric;
}

}  // namespace softland::internal
