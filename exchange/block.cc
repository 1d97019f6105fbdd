#include "exchange/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/measure.h"

namespace softland::internal {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
// Some instruments write settings, such as "Sample interval, 1e-6", in further columns beside the first rows of numbers. In
// rows after this number of rows, a text in these columns is an error.
constexpr std::size_t longest_preamble = 64;

class BlockReader {
 public:
  BlockReader(std::string_view text, const Refusals& refusals, const ReadKeys& keys)
      : text_(text), refusals_(refusals), keys_(keys) {
    decimal_.is_given = keys.decimal != '\0';
    decimal_.sign = keys.decimal;
  }
  Block read();

 private:
  [[noreturn]] void fail(std::size_t line, std::size_t column, const std::string& rule) const {
    refusals_.fail(line, column, rule);
  }

  void find_layout();
  [[nodiscard]] bool begins_block(const CellList& cells) const;
  void make_columns();
  void read_lines();
  void take_headings(const std::vector<Line>& above);
  void refuse_shifted(const CellList& cells, std::size_t line) const;
  [[nodiscard]] CellList units_in(const CellList& cells) const;
  [[nodiscard]] bool may_be_headings(const CellList& cells) const;
  void read_row(const CellList& cells, std::size_t line, bool unended);
  void take_number(std::size_t k, const Cell& cell, std::string_view text, std::size_t line, bool unended);
  void take_unit(std::size_t k, Cell& cell, std::string_view text, std::size_t line, bool unended);
  [[nodiscard]] bool was_cut(const CellList& cells) const;
  void take_beside(const CellList& cells, std::size_t line, std::string_view text);
  [[nodiscard]] CellList paired(const CellList& cells, std::size_t line) const;
  void look_for_pairs(const CellList& cells);
  void refuse_two_meanings() const;
  void refuse_broken_row(const std::vector<Line>& above) const;

  std::string_view text_;
  const Refusals& refusals_;
  const ReadKeys& keys_;
  DecimalSign decimal_;
  char separator_ = ',';
  bool pairs_ = false;        // true: commas are both decimal signs and separators, as in 0,5,1,25 for 0.5 and 1.25
  bool may_be_pairs_ = true;  // true while every row may consist of numbers with decimal commas, as in 0,5,1,25
  std::vector<bool> is_numeric_;
  Block block_;
  CellList headings_;  // headings of all columns of the file, above the numbers
  std::string_view first_row_;
  std::size_t width_ = 0;  // number of cells of a row
  std::size_t rows_with_words_ = 0;
  std::vector<std::optional<Unit>> cell_units_;  // unit written beside the numbers of each column, as in "5.0 V"
  std::size_t last_length_ = 0;                  // length of each row's last cell, if equal in all rows so far, else 0
};

void BlockReader::find_layout() {
  const std::vector<Line> last = last_lines(text_, static_cast<std::size_t>(keys_.skip));
  if (last.empty()) refusals_.fail("the file must hold columns of numbers, but has no lines");
  separator_ = separator_of(last);
  is_numeric_ = numeric_columns(last, separator_);
  if (is_numeric_.empty()) refusals_.fail("no columns of numbers were found; export times and volts as text");
  pairs_ = keys_.decimal == ',' && separator_ == ',' && text_.find('"') == std::string_view::npos;
  if (pairs_) {
    CellList cells;
    split_row(last.front().text, separator_, cells);
    while (!cells.empty() && cells.back().empty()) cells.pop_back();
    is_numeric_.assign((cells.size() + 1) / 2, true);
  }
}

bool BlockReader::begins_block(const CellList& cells) const {
  if (cells.size() < is_numeric_.size()) return false;
  bool has_number = false;
  for (std::size_t i = 0; i < is_numeric_.size(); ++i) {
    if (!is_numeric_[i]) continue;
    if (!may_be_value(cells[i])) return false;
    has_number |= holds_number(cells[i]);
  }
  // In a file with a single column of numbers, a line with a text in front of the number is not a row of the record, but a
  // setting of the instrument with its value.
  const std::size_t last = is_numeric_.size() - 1;
  const bool is_only = std::count(is_numeric_.begin(), is_numeric_.end(), true) == 1;
  const bool has_key = is_only && std::any_of(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(last),
                                              [](std::string_view cell) { return !cell.empty(); });
  return has_number && !has_key;
}

// Joins each pair of cells to a number with a decimal comma: the first cell is the whole part, the second the fraction.
CellList BlockReader::paired(const CellList& cells, std::size_t line) const {
  std::size_t count = cells.size();
  while (count > 0 && cells[count - 1].empty()) --count;
  if (count % 2 != 0 || count / 2 != is_numeric_.size())
    fail(line, 0,
         fmt::format("the row has {} parts between commas; with decimal = \",\" each number has two parts, "
                     "and every row must have as many as the last one",
                     count));
  CellList numbers;
  for (std::size_t i = 0; i < count; i += 2) {
    const char* const begin = cells[i].data();
    numbers.emplace_back(begin, static_cast<std::size_t>(cells[i + 1].data() + cells[i + 1].size() - begin));
  }
  return numbers;
}

void BlockReader::look_for_pairs(const CellList& cells) {
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

void BlockReader::take_beside(const CellList& cells, std::size_t line, std::string_view text) {
  CellList others;
  bool has_others = false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool is_other = i >= is_numeric_.size() || !is_numeric_[i];
    others.push_back(is_other ? cells[i] : std::string_view());
    if (!is_other || cells[i].empty()) continue;
    has_others = true;
    if (block_.lines.empty() && i < headings_.size() && !headings_[i].empty()) block_.preamble.take(headings_[i], cells[i]);
  }
  if (!has_others) return;
  ++rows_with_words_;
  if (cells.size() != width_ && !block_.lines.empty()) return;  // read_row() refuses rows of different numbers of cells
  if (block_.lines.size() >= longest_preamble) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!others[i].empty())
        fail(line, i + 1, fmt::format("is \"{}\" where most rows have no number; it must be blank", shown_cell(cells[i])));
    }
  }
  block_.preamble.take_line(text, others);
}

// Returns the number of characters of a number's text without the sign.
std::size_t digits_in(std::string_view cell) { return cell.size() - (cell.starts_with('-') || cell.starts_with('+') ? 1 : 0); }

// Returns true if the file may end in the middle of a number: the last number of `cells`, the last row, is shorter than the
// last number of all other rows, which have equal length.
bool BlockReader::was_cut(const CellList& cells) const {
  constexpr std::size_t fewest = 3;
  return block_.lines.size() >= fewest && digits_in(cells[is_numeric_.size() - 1]) < last_length_;
}

void BlockReader::take_number(std::size_t k, const Cell& cell, std::string_view text, std::size_t line, bool unended) {
  const std::size_t row = block_.lines.size();
  block_.values[k].push_back(cell.kind == CellKind::number ? cell.value : not_a_number);
  Missing& missing = block_.missing[k];
  if (cell.kind == CellKind::number) {
    // Counting significant digits takes time, so count them only in rows whose index is a power of two, and in the last row.
    if ((row & (row - 1)) == 0 || unended) block_.digits[k] = std::max(block_.digits[k], significant_digits(text));
  } else if (missing.count++ == 0) {
    missing.line = line;
    missing.is_overrange = cell.kind == CellKind::not_finite;
  }
}

// Converts a number with a unit to the first unit of its column, as for "-999 ns" above "1 us". Either all numbers of a column
// have a unit, or none.
void BlockReader::take_unit(std::size_t k, Cell& cell, std::string_view text, std::size_t line, bool unended) {
  std::optional<Unit>& unit = cell_units_[k];
  const auto refuse = [&](const std::string& why) {
    fail(line, static_cast<std::size_t>(block_.columns[k]),
         fmt::format("is \"{}\", and numbers above {}", shown_cell(text), why));
  };
  if (cell.kind == CellKind::number && unit && cell.value != 0) {
    if (!unended) refuse("have a unit, " + unit->symbol);
    cell.kind = CellKind::no_number;
  }
  if (cell.kind != CellKind::no_number) return;
  const std::optional<Measured> number = measured_cell(text);
  if (!number) return;
  if (!unit && block_.lines.size() == block_.missing[k].count) {
    unit = number->unit;
    block_.units[k] = unit->symbol;
  }
  if (!unit) refuse("have none");
  if (unit->measure != number->unit->measure || (unit->measure == Measure::other && unit->symbol != number->unit->symbol))
    refuse("are in " + unit->symbol);
  cell = read_cell(number->number, decimal_);
  if (unit->per_si != number->unit->per_si) cell.value = number->si() * unit->per_si;
}

void BlockReader::read_row(const CellList& cells, std::size_t line, bool unended) {
  const auto cut = [&](const std::string& why) {
    // A row more than twice as long as the first one is damaged, not cut by the end of the file.
    if (cells.back().data() + cells.back().size() - cells.front().data() > static_cast<std::ptrdiff_t>(2 * first_row_.size()))
      fail(line, 0, why);
    block_.left_out.push_back(fmt::format("line {}: {}: the file ends in the middle of it", line, why));
  };
  if (block_.lines.empty()) width_ = cells.size();
  if (unended && cells.size() < width_) return cut(fmt::format("it has {} cells, and rows have {}", cells.size(), width_));
  if (cells.size() != width_)
    fail(line, 0,
         fmt::format("the row has {} cells; it must have {}, as the rows above{}", cells.size(), width_,
                     separator_ == ',' && decimal_.sign != '.' ? " (decimal = \",\" reads commas as decimal signs)" : ""));
  if (unended && was_cut(cells)) return cut("its last number is shorter than those above");
  std::size_t k = 0;
  for (std::size_t i = 0; i < is_numeric_.size(); ++i) {
    if (!is_numeric_[i]) continue;
    Cell cell = read_cell(cells[i], decimal_);
    take_unit(k, cell, cells[i], line, unended);
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
      fail(line, i + 1,
           fmt::format("is \"{}\", but earlier numbers have the decimal sign \"{}\"; give decimal = \".\" or \",\"",
                       shown_cell(cells[i]), decimal_.sign));
    take_number(k, cell, cells[i], line, unended);
    ++k;
  }
  const std::size_t length = digits_in(cells[is_numeric_.size() - 1]);
  last_length_ = block_.lines.empty() || last_length_ == length ? length : 0;
  look_for_pairs(cells);
  block_.lines.push_back(static_cast<std::uint32_t>(line));
}

// Returns true if a line above the numbers has a cell for nearly every column of numbers, so that it may name the columns.
bool BlockReader::may_be_headings(const CellList& cells) const {
  const auto filled = std::count_if(cells.begin(), cells.end(), [](std::string_view cell) { return !cell.empty(); });
  const auto due = std::count(is_numeric_.begin(), is_numeric_.end(), true);
  return filled > 0 && filled + 1 >= due && !(due > 1 && cells.size() == 1);
}

// Returns the cells of a line if every cell above a column of numbers is a unit or blank; otherwise an empty list.
CellList BlockReader::units_in(const CellList& cells) const {
  bool has_unit = false;
  for (std::size_t i = 0; i < std::min(cells.size(), is_numeric_.size()); ++i) {
    if (!is_numeric_[i] || cells[i].empty()) continue;
    if (!unit_of(cells[i])) return {};
    has_unit = true;
  }
  return has_unit ? cells : CellList{};
}

// Refuses a heading with a unit to the right of the last column of numbers. Some column name then contains the separator, which
// shifts all names after it to wrong columns.
void BlockReader::refuse_shifted(const CellList& cells, std::size_t line) const {
  for (std::size_t i = is_numeric_.size(); i < cells.size(); ++i) {
    if (unit_of(cells[i]) || heading_of(cells[i]).unit)
      fail(line, i + 1,
           fmt::format("\"{}\" has a unit, but the rows have only {} columns: quote the name that contains the separator, "
                       "or skip the line and give unit and time_unit",
                       shown_cell(cells[i]), is_numeric_.size()));
  }
}

// Reads names and units of columns above the numbers. If all cells of the last line are units, the line above it has the names;
// otherwise the last line has the names.
void BlockReader::take_headings(const std::vector<Line>& above) {
  std::vector<CellList> cells(above.size());
  for (std::size_t i = 0; i < above.size(); ++i) {
    split_row(above[i].text, separator_, cells[i]);
    block_.preamble.take_line(above[i].text, cells[i]);
  }
  if (!above.empty()) refuse_shifted(cells.back(), above.back().number);
  std::size_t next = above.size();
  CellList units;
  if (next > 0 && is_setting(cells[next - 1])) next = 0;
  if (next > 0 && may_be_headings(cells[next - 1])) units = units_in(cells[next - 1]);
  if (!units.empty()) --next;
  CellList names;
  // A comment line does not name the columns.
  const bool is_comment =
      next > 0 && std::string_view("#;%").find(trimmed(above[next - 1].text).front()) != std::string_view::npos;
  if (next > 0 && may_be_headings(cells[next - 1]) && !is_comment) {
    const CellList& line = cells[next - 1];
    const bool has_text =
        std::any_of(line.begin(), line.end(), [](std::string_view c) { return !c.empty() && !looks_like_number(c); });
    if (has_text) names = line;
    refuse_shifted(names, above[next - 1].number);
  }
  headings_ = names;
  block_.has_headings = !names.empty();
  for (const int column : block_.columns) {
    const auto i = static_cast<std::size_t>(column - 1);
    block_.names.emplace_back(i < names.size() ? names[i] : std::string_view());
    block_.units.emplace_back(i < units.size() ? units[i] : std::string_view());
  }
  // A heading above a column without numbers may be a setting of the instrument; its value is then below, in the row of units.
  for (std::size_t i = 0; i < std::min(names.size(), units.size()); ++i) {
    if ((i >= is_numeric_.size() || !is_numeric_[i]) && !names[i].empty()) block_.preamble.take(names[i], units[i]);
  }
}

void BlockReader::make_columns() {
  for (std::size_t i = 0; i < is_numeric_.size(); ++i) {
    if (is_numeric_[i]) block_.columns.push_back(static_cast<int>(i + 1));
  }
  const std::size_t count = block_.columns.size();
  block_.values.resize(count);
  block_.missing.resize(count);
  block_.digits.resize(count);
  cell_units_.resize(count);
  for (std::vector<double>& column : block_.values) column.reserve(text_.size() / (8 * count + 8));
}

void BlockReader::read_lines() {
  std::vector<Line> above;
  bool in_block = false;
  CellList cells;
  Lines lines(text_);
  while (lines.next()) {
    if (lines.number() <= static_cast<std::size_t>(keys_.skip)) continue;
    if (trimmed(lines.line()).empty()) continue;
    split_row(lines.line(), separator_, cells);
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
    if (lines.is_unended() && block_.lines.back() == lines.number()) block_.notes.emplace_back(may_be_cut);
  }
}

// Refuses a damaged row at the begin of the numbers, which would otherwise be skipped as a line above them. Such a line has one
// invalid cell and follows units or a heading of times, or it begins like a number.
void BlockReader::refuse_broken_row(const std::vector<Line>& above) const {
  CellList cells, before;
  if (!above.empty()) {
    split_row(above.back().text, separator_, cells);
    const bool is_row = numbers_in(cells) > 0 && std::all_of(cells.begin(), cells.end(), may_be_value);
    if (is_row)
      fail(above.back().number, 0,
           fmt::format("the row has {} cells; it must have {}, as the rows below (skip leaves out lines at the beginning)",
                       cells.size(), is_numeric_.size()));
  }
  for (std::size_t i = 0; i < above.size(); ++i) {
    const std::string_view first = trimmed(above[i].text);
    const bool begins_as_number = first.find_first_of("0123456789") <= 2 &&
                                  std::isalpha(static_cast<unsigned char>(first.front())) == 0 && first.front() != '#';
    if (begins_as_number && std::ranges::count(first, '"') % 2 != 0)
      fail(above[i].number, 0, "a quote is not closed (skip leaves out lines at the beginning)");
    split_row(above[i].text, separator_, cells);
    if (cells.size() < is_numeric_.size()) continue;
    std::optional<std::size_t> broken;
    bool has_number = false;
    for (std::size_t k = 0; k < is_numeric_.size(); ++k) {
      if (!is_numeric_[k]) continue;
      has_number |= holds_number(cells[k]);
      if (!broken && !may_be_value(cells[k])) broken = k;
    }
    if (!broken || (!has_number && is_numeric_.size() > 1)) continue;
    bool is_below_heading = false;
    if (i > 0 && i + 1 == above.size()) {
      split_row(above[i - 1].text, separator_, before);
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

// Refuses a file of rows such as 0,5,1,25 unless the user gives the decimal sign: each row may be four numbers or two.
void BlockReader::refuse_two_meanings() const {
  if (decimal_.is_given || separator_ != ',' || !may_be_pairs_) return;
  const auto named = std::count_if(headings_.begin(), headings_.end(), [](std::string_view cell) { return !cell.empty(); });
  const auto with_units =
      std::count_if(block_.units.begin(), block_.units.end(), [](const std::string& unit) { return !unit.empty(); });
  if (static_cast<std::size_t>(std::max(named, with_units)) == is_numeric_.size()) return;
  fail(block_.lines.front(), 0,
       fmt::format("\"{}\" can be {} whole numbers or {} with a decimal comma; give decimal = \".\" or decimal = \",\"",
                   shown_cell(first_row_), is_numeric_.size(), is_numeric_.size() / 2));
}

Block BlockReader::read() {
  find_layout();
  make_columns();
  read_lines();
  if (block_.lines.empty()) refusals_.fail("no row of numbers was found below the headings");
  if (2 * rows_with_words_ >= block_.lines.size() && rows_with_words_ > 0)
    refusals_.fail("no columns of numbers were found: most lines contain words");
  refuse_two_meanings();
  return std::move(block_);
}

}  // namespace

Block read_block(std::string_view text, const Refusals& refusals, const ReadKeys& keys) {
  return BlockReader(text, refusals, keys).read();
}

}  // namespace softland::internal
