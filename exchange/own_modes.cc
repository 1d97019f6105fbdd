#include "exchange/own_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/layout.h"

namespace softland::internal {
namespace {

constexpr std::string_view position_name = "x_m", width_name = "width_m", offset_name = "rest_offset_m",
                           frequency_name = "frequency_Hz", mode_name = "mode_";

/// Reads the next line of a table of modes that is neither blank nor a comment.
bool next_row(Lines& lines, std::vector<std::string_view>& cells) {
  while (lines.next()) {
    const std::string_view line = trimmed(lines.line());
    if (line.empty() || line.starts_with('#')) continue;
    split_cells(line, ',', cells);
    return true;
  }
  return false;
}

class ModeCsvReader {
 public:
  ModeCsvReader(std::string_view text, const std::string& file) : lines_(text), refusals_(file) {
    made_.file = file;
    made_.format = "table of modes";
  }

  ModeTable read() {
    read_header();
    read_frequencies();
    while (next_row(lines_, cells_)) read_row();
    if (lines_.is_unended()) made_.notes.emplace_back("the last line has no end: it may have been cut");
    return std::move(made_);
  }

 private:
  [[noreturn]] void fail(std::size_t column, const std::string& rule) const { refusals_.fail(lines_.number(), column, rule); }

  void read_header() {
    if (!next_row(lines_, cells_)) refusals_.fail("the file is empty");
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const std::string_view name = cells_[k];
      const bool is_mode = name.starts_with(mode_name);
      if (is_mode) {
        if (name != fmt::format("{}{}", mode_name, made_.shapes.size() + 1))
          fail(k + 1, fmt::format("\"{}\" must be {}{}", shown_cell(name), mode_name, made_.shapes.size() + 1));
        made_.shapes.emplace_back();
        columns_.push_back(ColumnKind::mode);
        continue;
      }
      const ColumnKind kind = name == position_name ? ColumnKind::position
                              : name == width_name  ? ColumnKind::width
                              : name == offset_name ? ColumnKind::offset
                                                    : ColumnKind::none;
      if (kind == ColumnKind::none || !made_.shapes.empty() ||
          std::find(columns_.begin(), columns_.end(), kind) != columns_.end())
        fail(k + 1, fmt::format("\"{}\": columns must be {}, {} and {}, then {}1, {}2 and so on, each once", shown_cell(name),
                                position_name, width_name, offset_name, mode_name, mode_name));
      columns_.push_back(kind);
    }
    if (columns_.empty() || columns_.front() != ColumnKind::position || made_.shapes.empty())
      fail(1, fmt::format("the columns must be {} first and {}1 after it", position_name, mode_name));
  }

  void check_count() const {
    if (cells_.size() != columns_.size())
      fail(0, fmt::format("the row has {} cells; it must have {}, one per name of a column", cells_.size(), columns_.size()));
  }
  double number(std::size_t column) const {
    const std::optional<double> value = plain_decimal(cells_[column]);
    if (!value) fail(column + 1, fmt::format("\"{}\" must be a finite number", shown_cell(cells_[column])));
    return *value;
  }

  void read_frequencies() {
    if (!next_row(lines_, cells_)) refusals_.fail(fmt::format("the file ends before the row {}", frequency_name));
    check_count();
    if (cells_.front() != frequency_name)
      fail(1, fmt::format("\"{}\": expected the row {}", shown_cell(cells_.front()), frequency_name));
    for (std::size_t k = 1; k < columns_.size(); ++k) {
      if (columns_[k] == ColumnKind::mode) {
        made_.frequencies.push_back(number(k));
      } else if (!cells_[k].empty()) {
        fail(k + 1, "must be empty");
      }
    }
  }

  void read_row() {
    check_count();
    std::size_t mode = 0;
    double width = std::numeric_limits<double>::quiet_NaN(), offset = 0;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      switch (columns_[k]) {
        case ColumnKind::position:
          made_.positions.push_back(number(k));
          break;
        case ColumnKind::width:
          if (!cells_[k].empty()) width = number(k);
          break;
        case ColumnKind::offset:
          if (!cells_[k].empty()) offset = number(k);
          break;
        case ColumnKind::mode:
          made_.shapes[mode++].push_back(number(k));
          break;
        case ColumnKind::none:
          break;
      }
    }
    const std::vector<double>& x = made_.positions;
    if (x.size() > 1 && !(x.back() > x[x.size() - 2])) fail(1, "positions must increase from row to row");
    if (!std::isnan(width) && !(width > 0)) fail(0, "a width must be positive");
    made_.widths.push_back(width);
    made_.rest_offsets.push_back(offset);
  }

  enum class ColumnKind { none, position, width, offset, mode };
  Lines lines_;
  Refusals refusals_;
  ModeTable made_;
  std::vector<ColumnKind> columns_;
  std::vector<std::string_view> cells_;
};

}  // namespace

bool is_mode_csv(std::string_view text) {
  Lines lines(text.substr(0, 65536));
  std::vector<std::string_view> cells;
  if (!next_row(lines, cells)) return false;
  return cells.front() == position_name ||
         std::any_of(cells.begin(), cells.end(), [](std::string_view cell) { return cell.starts_with(mode_name); });
}

ModeTable read_mode_csv(std::string_view text, const std::string& file) { return ModeCsvReader(text, file).read(); }

}  // namespace softland::internal
