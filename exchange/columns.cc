#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <deque>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"
#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/measure.h"
#include "exchange/parsers.h"
#include "exchange/preamble.h"

namespace softland::internal {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
// Rows beside which a preamble may stand.
constexpr std::size_t longest_preamble = 64;

using CellList = std::vector<std::string_view>;

std::string shown_cell(std::string_view cell) { return printable_line(shortened(cell, 40)); }

bool is_blank(const CellList& cells) {
  return std::all_of(cells.begin(), cells.end(), [](std::string_view cell) { return cell.empty(); });
}

bool may_be_value(std::string_view cell) {
  DecimalSign any;
  const CellKind kind = read_cell(cell, any).kind;
  return kind == CellKind::number || kind == CellKind::blank || kind == CellKind::not_finite;
}

/// A line of the file; its cells are views of it.
struct Line {
  std::string_view text;
  std::size_t number = 0;
};

/// The last lines that hold numbers, from the last one up; a last line that the end of the file may have cut comes last of all.
std::vector<Line> last_lines(std::string_view text, std::size_t skip) {
  constexpr std::size_t enough = 13;
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

std::size_t numbers_in(const CellList& cells) {
  return static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), looks_like_number));
}

/// What separates the cells of these lines: that with which most of them are numbers alone, or else hold one.
char separator_of(const std::vector<Line>& lines) {
  constexpr std::array separators{'\t', ';', ',', ' '};
  CellList cells;
  for (const bool alone : {true, false}) {
    for (const char separator : separators) {
      std::size_t fitting = 0;
      for (const Line& line : lines) {
        split_cells(line.text, separator, cells);
        const std::size_t numbers = numbers_in(cells);
        const bool all = std::all_of(cells.begin(), cells.end(), may_be_value);
        fitting += cells.size() > 1 && numbers > 0 && (all || !alone);
      }
      if (2 * fitting > lines.size()) return separator;
    }
  }
  return ',';
}

/// Which columns hold numbers: those that hold more of them than words in the last lines, as far up as lines hold any. Numbers of
/// lines without words decide where there are such lines.
std::vector<bool> numeric_columns(const std::vector<Line>& last, char separator) {
  std::vector<bool> is_numeric;
  for (const bool without_words : {true, false}) {
    std::vector<int> excess;  // of numbers over words and cells that are not there
    CellList cells;
    int lines = 0;
    for (const Line& line : last) {
      split_cells(line.text, separator, cells);
      if (numbers_in(cells) == 0) break;
      if (excess.size() < cells.size()) excess.resize(cells.size(), -lines);
      const bool counts = !without_words || std::all_of(cells.begin(), cells.end(), may_be_value);
      for (std::size_t i = 0; i < excess.size(); ++i) {
        DecimalSign any;
        const CellKind kind = i < cells.size() ? read_cell(cells[i], any).kind : CellKind::no_number;
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

/// Rows of numbers that stand in lines instead of columns.
struct Block {
  std::vector<int> columns;                 ///< in the file, from 1
  std::vector<std::vector<double>> values;  ///< NaN where a number is missing
  std::vector<Missing> missing;
  std::vector<std::uint32_t> lines;
  std::vector<std::string> names, units;  ///< of the columns, as they stand above them; empty where there are none
  std::vector<int> digits;                ///< significant ones of the numbers of each column, of some rows
  bool has_headings = false;
};

class ColumnReader {
 public:
  ColumnReader(std::string_view text, const std::string& file, const ReadKeys& keys) : text_(text), file_(file), keys_(keys) {
    decimal_.is_given = keys.decimal != '\0';
    decimal_.sign = keys.decimal;
  }
  Recording read();

 private:
  [[noreturn]] void fail(std::size_t line, std::size_t column, const std::string& rule) const {
    throw InvalidInput(column == 0 ? fmt::format("{}:{}: {}", file_, line, rule)
                                   : fmt::format("{}:{}: column {}: {}", file_, line, column, rule));
  }
  [[noreturn]] void fail(const std::string& rule) const { throw InvalidInput(fmt::format("{}: {}", file_, rule)); }

  void find_layout();
  bool begins_block(const CellList& cells) const;
  void read_lines();
  void take_headings(const std::vector<Line>& above);
  void read_row(const CellList& cells, std::size_t line, bool unended);
  bool was_cut(const CellList& cells) const;
  void take_beside(const CellList& cells, std::size_t line, std::string_view text);
  void look_for_pairs(const CellList& cells);
  void refuse_two_meanings() const;
  void refuse_broken_row(const std::vector<Line>& above) const;
  CellList paired(const CellList& cells, std::size_t line) const;
  void drop_rows_without_numbers();
  bool read_lying_rows();
  Recording recording();
  std::optional<std::size_t> time_place() const;
  std::optional<std::size_t> named_place(const std::string& name, int number, std::string_view key) const;
  void set_times(Recording& made, std::optional<std::size_t> place);
  void set_even_times(Recording& made) const;
  bool is_same_heading(std::size_t k, std::size_t time) const;
  void scale_codes(Recording& made) const;
  void refuse_spectrum() const;
  void refuse_logic_states(const Recording& made) const;

  std::string_view text_;
  const std::string& file_;
  const ReadKeys& keys_;
  DecimalSign decimal_;
  char separator_ = ',';
  bool pairs_ = false;        // a decimal comma beside a comma that separates
  bool may_be_pairs_ = true;  // all rows so far could be such pairs
  std::vector<bool> is_numeric_;
  Block block_;
  Preamble preamble_;
  std::vector<std::string> left_out_, notes_;
  CellList heading_cells_;  // of the line of names, of columns without numbers too
  std::string_view first_row_;
  std::size_t width_ = 0;  // cells of a row
  std::size_t rows_with_text_ = 0;
  std::size_t last_length_ = 0;  // of the last cell of all rows so far; 0 where they differ
};

void ColumnReader::find_layout() {
  const std::vector<Line> last = last_lines(text_, static_cast<std::size_t>(keys_.skip));
  if (last.empty()) fail("the file holds no lines; it must hold columns of numbers");
  separator_ = separator_of(last);
  is_numeric_ = numeric_columns(last, separator_);
  if (is_numeric_.empty()) fail("no columns of numbers were found; what is read are exports as text, with times and volts");
  pairs_ = keys_.decimal == ',' && separator_ == ',' && text_.find('"') == std::string_view::npos;
  if (pairs_) {
    CellList cells;
    split_cells(last.front().text, separator_, cells);
    while (!cells.empty() && cells.back().empty()) cells.pop_back();
    is_numeric_.assign((cells.size() + 1) / 2, true);
  }
}

bool ColumnReader::begins_block(const CellList& cells) const {
  if (cells.size() < is_numeric_.size()) return false;
  bool has_number = false;
  for (std::size_t i = 0; i < is_numeric_.size(); ++i) {
    if (!is_numeric_[i]) continue;
    if (!may_be_value(cells[i])) return false;
    has_number |= looks_like_number(cells[i]);
  }
  return has_number;
}

// Two cells each are the whole and the fraction of one number.
CellList ColumnReader::paired(const CellList& cells, std::size_t line) const {
  std::size_t count = cells.size();
  while (count > 0 && cells[count - 1].empty()) --count;
  if (count % 2 != 0 || count / 2 != is_numeric_.size())
    fail(line, 0,
         fmt::format("the row has {} parts between commas; with decimal = \",\" every number takes two, and rows have as many "
                     "as the last one",
                     count));
  CellList numbers;
  for (std::size_t i = 0; i < count; i += 2) {
    const char* const begin = cells[i].data();
    numbers.emplace_back(begin, static_cast<std::size_t>(cells[i + 1].data() + cells[i + 1].size() - begin));
  }
  return numbers;
}

void ColumnReader::look_for_pairs(const CellList& cells) {
  if (!may_be_pairs_ || separator_ != ',' || decimal_.is_given) return;
  const auto is_whole = [](std::string_view cell, bool may_have_sign) {
    if (may_have_sign && (cell.starts_with('-') || cell.starts_with('+'))) cell.remove_prefix(1);
    return !cell.empty() && cell.find_first_not_of("0123456789") == std::string_view::npos;
  };
  std::size_t count = cells.size();
  while (count > 0 && cells[count - 1].empty()) --count;
  may_be_pairs_ = count >= 2 && count % 2 == 0;
  for (std::size_t i = 0; may_be_pairs_ && i + 1 < count; i += 2) {
    const std::string_view fraction = cells[i + 1].substr(0, cells[i + 1].find_first_of("eE"));
    may_be_pairs_ = is_whole(cells[i], true) && is_whole(fraction, false);
  }
}

void ColumnReader::take_beside(const CellList& cells, std::size_t line, std::string_view text) {
  CellList others;
  bool has_others = false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool is_other = i >= is_numeric_.size() || !is_numeric_[i];
    others.push_back(is_other ? cells[i] : std::string_view());
    if (!is_other || cells[i].empty()) continue;
    has_others = true;
    if (block_.lines.empty() && i < heading_cells_.size() && !heading_cells_[i].empty())
      preamble_.take(heading_cells_[i], cells[i]);
  }
  if (!has_others) return;
  ++rows_with_text_;
  if (cells.size() != width_ && !block_.lines.empty()) return;  // read_row() refuses it
  if (block_.lines.size() >= longest_preamble) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!others[i].empty())
        fail(line, i + 1, fmt::format("is \"{}\" where most rows have no number; it must be blank", shown_cell(cells[i])));
    }
  }
  preamble_.take_line(text, others);
}

// What a number takes without its sign.
std::size_t digits_in(std::string_view cell) { return cell.size() - (cell.starts_with('-') || cell.starts_with('+') ? 1 : 0); }

// Whether the last number of a last line without a line end is shorter than all numbers above it, which are of one length.
bool ColumnReader::was_cut(const CellList& cells) const {
  constexpr std::size_t fewest = 3;
  return block_.lines.size() >= fewest && digits_in(cells[is_numeric_.size() - 1]) < last_length_;
}

void ColumnReader::read_row(const CellList& cells, std::size_t line, bool unended) {
  const auto cut = [&](const std::string& why) {
    // What ends in the middle is shorter than a row.
    if (cells.back().data() + cells.back().size() - cells.front().data() > static_cast<std::ptrdiff_t>(2 * first_row_.size()))
      fail(line, 0, why);
    left_out_.push_back(fmt::format("line {}: {}: the file ends in the middle of it", line, why));
  };
  if (block_.lines.empty()) width_ = cells.size();
  if (unended && cells.size() < width_) return cut(fmt::format("it has {} cells, and rows have {}", cells.size(), width_));
  if (cells.size() != width_)
    fail(line, 0,
         fmt::format("the row has {} cells; it must have {} as the rows above{}", cells.size(), width_,
                     separator_ == ',' && decimal_.sign != '.' ? " (decimal = \",\" reads commas as decimal signs)" : ""));
  if (unended && was_cut(cells)) return cut("its last number is shorter than those above");
  std::size_t k = 0;
  for (std::size_t i = 0; i < is_numeric_.size(); ++i) {
    if (!is_numeric_[i]) continue;
    const Cell cell = read_cell(cells[i], decimal_);
    if (cell.kind == CellKind::no_number) {
      if (unended) {
        for (std::size_t j = 0; j < k; ++j) block_.values[j].pop_back();
        return cut(fmt::format("\"{}\" is no number", shown_cell(cells[i])));
      }
      fail(line, i + 1,
           fmt::format("is \"{}\"; it must be a number{}", shown_cell(cells[i]),
                       block_.lines.empty() ? " (skip leaves out lines at the beginning)" : ""));
    }
    if (cell.kind == CellKind::other_sign)
      fail(
          line, i + 1,
          fmt::format("is \"{}\", and numbers before it have the decimal sign \"{}\"; decimal = \".\" or \",\" says which is one",
                      shown_cell(cells[i]), decimal_.sign));
    block_.values[k].push_back(cell.kind == CellKind::number ? cell.value : not_a_number);
    Missing& missing = block_.missing[k];
    if (cell.kind == CellKind::number) {
      const std::size_t row = block_.lines.size();
      if ((row & (row - 1)) == 0 || unended) block_.digits[k] = std::max(block_.digits[k], significant_digits(cells[i]));
    } else if (missing.count++ == 0) {
      missing.line = line;
      missing.is_overrange = cell.kind == CellKind::not_finite;
    }
    ++k;
  }
  const std::size_t length = digits_in(cells[is_numeric_.size() - 1]);
  last_length_ = block_.lines.empty() || last_length_ == length ? length : 0;
  look_for_pairs(cells);
  block_.lines.push_back(static_cast<std::uint32_t>(line));
}

// The lines above the numbers: the last one holds units where all its cells do, the one above it, or else it, names.
void ColumnReader::take_headings(const std::vector<Line>& above) {
  std::vector<CellList> cells(above.size());
  for (std::size_t i = 0; i < above.size(); ++i) {
    split_cells(above[i].text, separator_, cells[i]);
    preamble_.take_line(above[i].text, cells[i]);
  }
  std::size_t next = above.size();
  const auto fits = [&](const CellList& line) {
    const auto filled = std::count_if(line.begin(), line.end(), [](std::string_view cell) { return !cell.empty(); });
    const auto due = std::count(is_numeric_.begin(), is_numeric_.end(), true);
    return filled > 0 && filled + 1 >= due && !(due > 1 && line.size() == 1);
  };
  const auto all_are_units = [&](const CellList& line) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(line.size(), is_numeric_.size()); ++i) {
      if (!is_numeric_[i] || line[i].empty()) continue;
      if (!unit_of(line[i])) return false;
      ++count;
    }
    return count > 0;
  };
  CellList units;
  if (next > 0 && all_are_units(cells[next - 1]) && fits(cells[next - 1])) units = cells[--next];
  CellList names;
  // A comment, or one key with its value, is no line of names.
  const bool is_comment =
      next > 0 && std::string_view("#;%").find(trimmed(above[next - 1].text).front()) != std::string_view::npos;
  if (next > 0 && fits(cells[next - 1]) && !is_comment) {
    const CellList& line = cells[next - 1];
    const bool has_text =
        std::any_of(line.begin(), line.end(), [](std::string_view c) { return !c.empty() && !looks_like_number(c); });
    if (has_text) names = line;
  }
  heading_cells_ = names;
  block_.has_headings = !names.empty();
  for (const int column : block_.columns) {
    const auto i = static_cast<std::size_t>(column - 1);
    block_.names.emplace_back(i < names.size() ? names[i] : std::string_view());
    block_.units.emplace_back(i < units.size() ? units[i] : std::string_view());
  }
  // Beyond the columns of numbers a name may have a value in the row of units.
  for (std::size_t i = 0; i < std::min(names.size(), units.size()); ++i) {
    if ((i >= is_numeric_.size() || !is_numeric_[i]) && !names[i].empty()) preamble_.take(names[i], units[i]);
  }
}

void ColumnReader::read_lines() {
  for (std::size_t i = 0; i < is_numeric_.size(); ++i) {
    if (is_numeric_[i]) block_.columns.push_back(static_cast<int>(i + 1));
  }
  const std::size_t count = block_.columns.size();
  block_.values.resize(count);
  block_.missing.resize(count);
  block_.digits.resize(count);
  for (std::vector<double>& column : block_.values) column.reserve(text_.size() / (8 * count + 8));

  std::vector<Line> above;
  bool in_block = false;
  CellList cells;
  Lines lines(text_);
  while (lines.next()) {
    if (lines.number() <= static_cast<std::size_t>(keys_.skip)) continue;
    if (trimmed(lines.line()).empty()) continue;
    split_cells(lines.line(), separator_, cells);
    if (!in_block) {
      if (!begins_block(cells)) {
        above.push_back({lines.line(), lines.number()});
        continue;
      }
      in_block = true;
      first_row_ = lines.line();
      take_headings(above);
      refuse_broken_row(above);
    } else if (is_blank(cells)) {
      continue;
    }
    if (pairs_) cells = paired(cells, lines.number());
    std::size_t filled = cells.size();
    while (filled > 0 && cells[filled - 1].empty()) --filled;
    if (filled > is_numeric_.size() || block_.columns.size() < is_numeric_.size())
      take_beside(cells, lines.number(), lines.line());
    read_row(cells, lines.number(), lines.is_unended());
    if (lines.is_unended() && block_.lines.back() == lines.number())
      notes_.emplace_back("the last line has no line end: its last number may have been cut");
  }
}

void ColumnReader::drop_rows_without_numbers() {
  std::size_t count = block_.lines.size();
  const std::optional<std::size_t> time = time_place();
  const auto is_empty = [&](std::size_t row) {
    for (std::size_t k = 0; k < block_.values.size(); ++k) {
      if (k != time && std::isfinite(block_.values[k][row])) return false;
    }
    return block_.values.size() > 1;
  };
  std::size_t dropped = 0;
  while (count > 0 && is_empty(count - 1)) {
    --count;
    ++dropped;
    for (std::size_t k = 0; k < block_.values.size(); ++k) {
      if (!std::isfinite(block_.values[k].back())) --block_.missing[k].count;
      block_.values[k].pop_back();
    }
    block_.lines.pop_back();
  }
  if (dropped > 0) left_out_.push_back(fmt::format("{} rows at the end without numbers", dropped));
}

// A line above the numbers that is a row but for one cell: it stands below units or a heading of times, or begins as a number
// does.
void ColumnReader::refuse_broken_row(const std::vector<Line>& above) const {
  CellList cells, before;
  if (!above.empty()) {
    split_cells(above.back().text, separator_, cells);
    const bool is_row = numbers_in(cells) > 0 && std::all_of(cells.begin(), cells.end(), may_be_value);
    if (is_row)
      fail(above.back().number, 0,
           fmt::format("the row has {} cells; it must have {} as those below (skip leaves out lines at the beginning)",
                       cells.size(), is_numeric_.size()));
  }
  for (std::size_t i = 0; i < above.size(); ++i) {
    split_cells(above[i].text, separator_, cells);
    if (cells.size() < is_numeric_.size()) continue;
    std::optional<std::size_t> broken;
    bool has_number = false;
    for (std::size_t k = 0; k < is_numeric_.size(); ++k) {
      if (!is_numeric_[k]) continue;
      has_number |= looks_like_number(cells[k]);
      if (!broken && !may_be_value(cells[k])) broken = k;
    }
    if (!broken || (!has_number && is_numeric_.size() > 1)) continue;
    const std::string_view first = trimmed(above[i].text);
    const bool begins_as_number = first.find_first_of("0123456789") <= 2 &&
                                  std::isalpha(static_cast<unsigned char>(first.front())) == 0 && first.front() != '#';
    bool is_below_heading = false;
    if (i > 0 && i + 1 == above.size()) {
      split_cells(above[i - 1].text, separator_, before);
      is_below_heading = std::any_of(before.begin(), before.end(), [](std::string_view cell) {
        const std::optional<Unit> own = unit_of(cell), named = heading_of(cell).unit;
        const bool is_time = (own && own->measure == Measure::time) || (named && named->measure == Measure::time);
        return is_time || lower_case(cell) == "time";
      });
    }
    if (begins_as_number || is_below_heading)
      fail(above[i].number, *broken + 1,
           fmt::format("is \"{}\"; it must be a number (skip leaves out lines at the beginning)", shown_cell(cells[*broken])));
  }
}

// A row such as 0,5,1,25 may be four numbers or two.
void ColumnReader::refuse_two_meanings() const {
  if (decimal_.is_given || separator_ != ',' || !may_be_pairs_) return;
  const auto named =
      std::count_if(heading_cells_.begin(), heading_cells_.end(), [](std::string_view cell) { return !cell.empty(); });
  const auto with_units =
      std::count_if(block_.units.begin(), block_.units.end(), [](const std::string& unit) { return !unit.empty(); });
  if (static_cast<std::size_t>(std::max(named, with_units)) == is_numeric_.size()) return;
  fail(block_.lines.front(), 0,
       fmt::format("\"{}\" can be {} whole numbers or {} with a decimal comma; decimal = \".\" or decimal = \",\" says which",
                   shown_cell(first_row_), is_numeric_.size(), is_numeric_.size() / 2));
}

// Lines that are channels, each with as many numbers: a name, and then numbers; or numbers alone.
bool ColumnReader::read_lying_rows() {
  constexpr std::size_t most_lines = 64, fewest_numbers = 3, fewest_unnamed = 16;
  std::vector<Line> all;
  Lines lines(text_);
  bool ends_unended = false;
  while (lines.next()) {
    ends_unended = lines.is_unended();
    if (lines.number() <= static_cast<std::size_t>(keys_.skip) || trimmed(lines.line()).empty()) continue;
    all.push_back({lines.line(), lines.number()});
    if (all.size() > most_lines) return false;
  }
  std::vector<CellList> rows;
  std::vector<Line> places, above;
  std::size_t width = 0;
  const char separator = all.empty() ? ',' : separator_of(all);
  for (const Line& line : all) {
    CellList cells;
    split_cells(line.text, separator, cells);
    while (!cells.empty() && cells.back().empty()) cells.pop_back();
    const bool has_name = !cells.empty() && !looks_like_number(cells.front());
    const std::size_t numbers = cells.size() - (has_name ? 1 : 0);
    if (rows.empty() && numbers_in(cells) < std::max(fewest_numbers, numbers)) {
      above.push_back(line);
      continue;
    }
    rows.push_back(cells);
    places.push_back(line);
    width = std::max(width, numbers);
  }
  const auto is_named = [](const CellList& c) {
    return std::isalpha(static_cast<unsigned char>(c.front().empty() ? ' ' : c.front().front())) != 0;
  };
  const bool named = !rows.empty() && std::all_of(rows.begin(), rows.end(), is_named);
  if (rows.size() < 2 || (named ? width < fewest_numbers : width < std::max(fewest_unnamed, 4 * rows.size()))) return false;
  CellList heads;
  for (const Line& line : above) {
    split_cells(line.text, separator, heads);
    if (!named && heads.size() >= width) return false;  // names of columns
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::size_t numbers = rows[r].size() - (named ? 1 : 0);
    if (numbers != width) {
      fail(places[r].number, 0,
           fmt::format("the row has {} numbers, and the longest has {}; rows that are channels must have as many", numbers,
                       width));
    }
  }
  separator_ = separator;
  for (const Line& line : above) {
    CellList cells;
    split_cells(line.text, separator_, cells);
    preamble_.take_line(line.text, cells);
  }
  block_ = Block{};
  block_.has_headings = named;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    block_.columns.push_back(static_cast<int>(r + 1));
    block_.names.emplace_back(named ? rows[r].front() : std::string_view());
    block_.units.emplace_back();
    block_.missing.emplace_back();
    block_.digits.push_back(significant_digits(rows[r].back()));
    std::vector<double>& values = block_.values.emplace_back();
    for (std::size_t i = named ? 1 : 0; i < rows[r].size(); ++i) {
      const Cell cell = read_cell(rows[r][i], decimal_);
      if (cell.kind != CellKind::number)
        fail(places[r].number, i + 1, fmt::format("is \"{}\"; it must be a finite number", shown_cell(rows[r][i])));
      values.push_back(cell.value);
    }
  }
  if (ends_unended) notes_.emplace_back("the last line has no line end: its last number may have been cut");
  block_.lines.assign(width, static_cast<std::uint32_t>(places.front().number));
  may_be_pairs_ = false;
  return true;
}

std::optional<std::size_t> ColumnReader::named_place(const std::string& name, int number, std::string_view key) const {
  if (name.empty() && number == 0) return std::nullopt;
  for (std::size_t k = 0; k < block_.columns.size(); ++k) {
    if (number != 0 ? block_.columns[k] == number : block_.names[k] == name || heading_of(block_.names[k]).name == name) return k;
  }
  fail(number != 0 ? fmt::format("{} = {}: there is no column of numbers in that place", key, number)
                   : fmt::format("{} = \"{}\": no column of numbers has this name", key, printable_line(name)));
}

std::optional<std::size_t> ColumnReader::time_place() const {
  if (const auto named = named_place(keys_.time_column, keys_.time_column_number, "time_column")) return named;
  const std::size_t count = block_.columns.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Heading heading = heading_of(block_.names[k]);
    const std::optional<Unit> own = unit_of(block_.units[k]);
    const std::optional<Unit>& unit = own ? own : heading.unit;
    if (unit && (unit->measure == Measure::time || unit->measure == Measure::samples)) return k;
  }
  constexpr std::array usual{"time", "t",     "x",     "x-axis", "xpos",  "times",  "timestamp",
                             "zeit", "temps", "tempo", "tiempo", "index", "sample", "n"};
  for (std::size_t k = 0; k < count; ++k) {
    const std::string name = lower_case(heading_of(block_.names[k]).name);
    if (std::find(usual.begin(), usual.end(), name) != usual.end()) return k;
  }
  if (block_.has_headings || count < 2) return std::nullopt;
  // Without names: the first column where it never falls, and does not stand still.
  const std::vector<double>& first = block_.values.front();
  const bool rises = std::is_sorted(first.begin(), first.end()) && first.front() < first.back();
  return rises ? std::optional<std::size_t>(0) : std::nullopt;
}

// Whether a column is a second one of times, unless the user says which one is.
bool ColumnReader::is_same_heading(std::size_t k, std::size_t time) const {
  const bool is_said = !keys_.time_column.empty() || keys_.time_column_number > 0;
  return !is_said && block_.has_headings && !block_.names[time].empty() && block_.names[k] == block_.names[time];
}

void ColumnReader::set_even_times(Recording& made) const {
  if (!made.interval) return;
  const std::size_t count = block_.lines.size();
  double start = 0;
  if (preamble_.start) {
    start = *preamble_.start;
  } else if (preamble_.trigger_sample) {
    start = -*preamble_.trigger_sample * *made.interval;
  } else if (preamble_.centre) {
    start = *preamble_.centre - static_cast<double>(count / 2) * *made.interval;
  }
  // Where the first sample is a whole number of intervals from t = 0, one sample is at 0 exactly.
  constexpr double whole = 1e-6;
  const double steps = start / *made.interval, rounded = std::round(steps);
  made.times.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<double>(i);
    made.times[i] = std::abs(steps - rounded) < whole ? (rounded + k) * *made.interval : start + k * *made.interval;
  }
}

void ColumnReader::set_times(Recording& made, std::optional<std::size_t> place) {
  made.interval = preamble_.interval;
  const std::size_t count = block_.lines.size();
  const bool is_period = place && block_.names[*place] == "xpos" && preamble_.frequency.value_or(0) > 0 &&
                         preamble_.samples == static_cast<double>(count);
  if (is_period) made.interval = 1 / (*preamble_.frequency * static_cast<double>(count));
  if (!place) return set_even_times(made);
  const std::vector<double>& raw = block_.values[*place];
  const Missing& missing = block_.missing[*place];
  if (missing.count > 0)
    fail(missing.line, static_cast<std::size_t>(block_.columns[*place]), "the time is missing; it must be a finite number");
  const Heading heading = heading_of(block_.names[*place]);
  std::optional<Unit> unit = unit_of(block_.units[*place]);
  if (!unit) unit = heading.unit;
  if (!keys_.time_unit.empty()) {
    unit = unit_of(keys_.time_unit);
    if (!unit || unit->measure != Measure::time)
      fail(fmt::format("time_unit = \"{}\" is no unit of time; there are s, ms, us, ns and ps", printable_line(keys_.time_unit)));
  }
  const auto is_whole = [](double value) { return value == std::floor(value); };
  const bool is_named_time = !heading.name.empty() && (heading.name[0] == 't' || heading.name[0] == 'T');
  const bool counts = (unit && unit->measure == Measure::samples) ||
                      (!unit && !is_named_time && made.interval && std::all_of(raw.begin(), raw.end(), is_whole));
  if (counts) {
    for (std::size_t i = 1; i < count; ++i) {
      if (raw[i] != raw[i - 1] + 1)
        fail(block_.lines[i], static_cast<std::size_t>(block_.columns[*place]),
             fmt::format("the number of the sample is {}, and that above {}; they must follow each other", raw[i], raw[i - 1]));
    }
    return set_even_times(made);
  }
  if (!unit && preamble_.horizontal_unit && preamble_.horizontal_unit->symbol == "s") unit = preamble_.horizontal_unit;
  made.times_have_unit = unit.has_value();
  if (!unit) unit = Unit{.measure = Measure::time, .symbol = "s"};
  if (unit->measure != Measure::time)
    fail(fmt::format("column {} is in {} and no time; time_column names another, or time_unit says its unit",
                     block_.columns[*place], unit->symbol));
  made.has_times = true;
  made.times.resize(count);
  for (std::size_t i = 0; i < count; ++i) made.times[i] = unit->in_si(raw[i]);
  const double largest = std::max(std::abs(made.times.front()), std::abs(made.times.back()));
  if (largest > 0) made.last_digit = std::pow(10, std::floor(std::log10(largest)) - block_.digits[*place] + 1);
}

// Codes of a converter that stand for volts.
void ColumnReader::scale_codes(Recording& made) const {
  constexpr double largest_code = 32767, codes_per_division = 25;
  std::size_t whole = 0, fractions = 0;
  for (const Channel& c : made.channels) {
    for (const double v : c.values) ++(v == std::floor(v) ? whole : fractions);
  }
  const bool are_codes = made.format == "GW Instek CSV" && !made.has_times && whole > fractions;
  if (are_codes && fractions > 0) fail("codes and fractions: one of both is no sample");
  if (are_codes && (made.channels.size() > 1 || !preamble_.vertical_scale))
    fail("codes whose volts per division cannot be told; save one channel per file");
  if (made.channels.size() != 1) return;
  Channel& channel = made.channels.front();
  double factor = 1, offset = 0;
  if (preamble_.high && preamble_.low && made.format == "Keysight arb") {
    const bool is_short = preamble_.text.find("short") != std::string::npos;
    factor = (*preamble_.high - *preamble_.low) / 2 / (is_short ? largest_code : 1);
    offset = (*preamble_.high + *preamble_.low) / 2;
    channel.name = channel.heading = "V";
    channel.unit = "V";
    channel.is_voltage = true;
  } else if (are_codes) {
    factor = *preamble_.vertical_scale / codes_per_division;
    made.notes.push_back(
        fmt::format("numbers are codes, {} of them a division of {} V", codes_per_division, *preamble_.vertical_scale));
  } else {
    return;
  }
  for (double& value : channel.values) value = offset + value * factor;
}

void ColumnReader::refuse_spectrum() const {
  if (preamble_.horizontal_unit && preamble_.horizontal_unit->measure == Measure::frequency)
    fail(fmt::format("a spectrum over {}; a record over time is due", preamble_.horizontal_unit->symbol));
  for (std::size_t k = 0; k < block_.columns.size(); ++k) {
    const Heading heading = heading_of(block_.names[k]);
    std::optional<Unit> unit = unit_of(block_.units[k]);
    if (!unit) unit = heading.unit;
    const bool is_frequency = (unit && unit->measure == Measure::frequency) || lower_case(heading.name).starts_with("freq");
    if (is_frequency && k == 0)
      fail(fmt::format("a spectrum: column {} is a frequency; a record over time is due", block_.columns[k]));
  }
}

void ColumnReader::refuse_logic_states(const Recording& made) const {
  const bool is_logic = !made.channels.empty() && std::all_of(made.channels.begin(), made.channels.end(), [&](const Channel& c) {
    const std::string name = lower_case(c.name);
    const bool is_named_so = name.starts_with("d") || name.starts_with("bit") || name.starts_with("logic") ||
                             name.starts_with("bus") || made.format == "sigrok CSV" ||
                             preamble_.text.find("logic") != std::string::npos ||
                             preamble_.text.find("digital") != std::string::npos;
    return is_named_so && c.unit.empty() &&
           std::all_of(c.values.begin(), c.values.end(), [](double v) { return v == 0 || v == 1; });
  });
  if (is_logic) fail("a capture of logic states: every channel is 0 or 1; a record of volts over time is due");
}

Recording ColumnReader::recording() {
  Recording made{.file = file_, .format = {}};
  refuse_spectrum();
  const std::optional<std::size_t> place = time_place();
  made.format = format_of(preamble_.text);
  set_times(made, place);
  const std::vector<double> times_as_written = place ? block_.values[*place] : std::vector<double>();
  made.lines = block_.lines;
  made.left_out = left_out_;
  made.notes = notes_;
  if (preamble_.samples && *preamble_.samples > static_cast<double>(block_.lines.size()))
    made.notes.push_back(fmt::format("the file speaks of {} samples and holds {}", *preamble_.samples, block_.lines.size()));
  const bool own =
      std::any_of(block_.names.begin(), block_.names.end(), [](const std::string& name) { return name == "time_s"; });
  if (own) made.format = "softland CSV";
  for (std::size_t k = 0; k < block_.columns.size(); ++k) {
    if (k == place) continue;
    Channel channel;
    const Heading heading = heading_of(block_.names[k]);
    if (place && is_same_heading(k, *place)) {
      if (block_.values[k] == times_as_written) continue;
      fail(fmt::format("columns {} and {} are both times, and differ; time_column says which one belongs to the channel",
                       block_.columns[*place], block_.columns[k]));
    }
    channel.heading = block_.names[k];
    channel.name = heading.name;
    channel.column = block_.columns[k];
    const bool is_only = block_.columns.size() == (place ? 2U : 1U);
    if (is_only && !preamble_.source.empty() && (channel.name.empty() || !place)) channel.name = preamble_.source;
    if (channel.name.empty()) channel.name = fmt::format("column {}", channel.column);
    std::optional<Unit> unit = unit_of(block_.units[k]);
    if (!unit) unit = heading.unit;
    if (!unit) unit = preamble_.vertical_unit;
    if (!unit && own) unit = unit_of("V");
    if (unit) {
      channel.unit = unit->symbol;
      channel.is_voltage = unit->measure == Measure::voltage;
      channel.per_si = unit->per_si;
    } else {
      channel.unit = printable_line(trimmed(block_.units[k]));
    }
    channel.values = std::move(block_.values[k]);
    channel.missing = block_.missing[k];
    made.channels.push_back(std::move(channel));
  }
  if (made.channels.empty()) fail("there is a column of times and none of values");
  scale_codes(made);
  refuse_logic_states(made);
  return made;
}

Recording ColumnReader::read() {
  find_layout();
  if (!read_lying_rows()) {
    read_lines();
    if (block_.lines.empty()) fail("no row of numbers was found below the headings");
    if (2 * rows_with_text_ >= block_.lines.size() && rows_with_text_ > 0)
      fail("no columns of numbers were found: most lines hold words as well");
    if (preamble_.samples && *preamble_.samples < static_cast<double>(block_.lines.size()) && block_.columns.size() == 1)
      fail(fmt::format("the file speaks of {} samples and holds {}", *preamble_.samples, block_.lines.size()));
    refuse_two_meanings();
    drop_rows_without_numbers();
    if (block_.lines.empty()) fail("no row has numbers");
  }
  return recording();
}

}  // namespace

Recording read_columns(std::string_view text, const std::string& file, const ReadKeys& keys) {
  return ColumnReader(text, file, keys).read();
}

}  // namespace softland::internal
