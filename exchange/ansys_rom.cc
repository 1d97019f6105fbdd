// Reads reduced-order models of ANSYS (.rom, for elements ROM144). The file has the frequencies of the modes and their shapes at
// a few nodes, each shape scaled to 1 at its largest value. It has no masses, and its units are those of the finite-element
// model.
//
// After the frequencies the file has the damping ratios, the range of every modal coordinate, and loads. A reduced-order model
// uses the modes whose range is not empty. Next are the numbers of the nodes, their directions of motion, their positions, and
// a row of shape values per mode. Source: the layout of files written by ANSYS 18; the element: ANSYS Mechanical APDL,
// Coupled-Field Analysis Guide, "Reduced Order Modeling".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/printable.h"
#include "base/shortened.h"
#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/layout.h"
#include "exchange/nodal_modes.h"

namespace softland::internal {
namespace {

/// A line of a .rom file that consists of numbers only.
struct Row {
  std::size_t line = 0;
  bool is_real = false;  ///< true if a number of the line has a decimal point
  std::vector<double> numbers;
};

class RomReader {
 public:
  RomReader(std::string_view text, const std::string& file) : refusals_(file) {
    Lines lines(text);
    bool first = true;
    while (lines.next()) {
      if (std::exchange(first, false)) continue;  // the first line, RELEASE, has no numbers
      std::vector<std::string_view> words;
      split_cells(lines.line(), ' ', words);
      Row row{.line = lines.number()};
      for (const std::string_view word : words) {
        const std::optional<double> value = word.empty() ? std::nullopt : plain_decimal(word);
        if (!value) {
          row.numbers.clear();
          break;
        }
        row.is_real = row.is_real || word.find('.') != std::string_view::npos;
        row.numbers.push_back(*value);
      }
      if (row.numbers.empty()) {
        end_ = row.line;
        break;  // after the last numbers come names of fitted functions, which are not read
      }
      rows_.push_back(std::move(row));
    }
  }

  NodalModes read() {
    NodalModes made{.format = "ANSYS .rom", .needs_length_unit = true};
    if (rows_.empty()) refusals_.fail("the file must hold numbers, but ends before them");
    const auto modes = static_cast<std::size_t>(count(rows_[0], 0, "the number of modes"));
    std::size_t at = 1;
    while (at < rows_.size() && !rows_[at].is_real) ++at;
    const std::vector<double> frequencies = reals(at, modes, "frequencies");
    for (std::size_t k = 0; k < modes; ++k) {
      if (!(frequencies[k] > 0) || (k > 0 && frequencies[k] < frequencies[k - 1]))
        fail(at, "the frequencies must be positive and increasing");
    }
    const std::vector<double> low = reals(at + 2, modes, "lower ends of the ranges"),
                              high = reals(at + 3, modes, "upper ends of the ranges");
    for (at += 4; at < rows_.size() && rows_[at].is_real; ++at) continue;
    read_nodes(made, at);
    for (std::size_t k = 0; k < modes; ++k) {
      const std::vector<double> shape = reals(at_shapes_ + k, made.nodes.size(), "numbers of a shape");
      NodalMode mode{.frequency = frequencies[k], .name = fmt::format("mode {}", k + 1), .is_used = high[k] > low[k]};
      for (std::size_t i = 0; i < made.nodes.size(); ++i) {
        Vector3 motion = no_motion;
        motion[directions_[i]] = shape[i];
        mode.motion.push_back(motion);
      }
      made.modes.push_back(std::move(mode));
    }
    if (at_shapes_ + modes != rows_.size() || end_ == 0) refusals_.fail("the file must end with the last number of the shapes");
    return made;
  }

 private:
  [[noreturn]] void fail(std::size_t row, const std::string& rule) const { refusals_.fail(rows_[row].line, 0, rule); }

  long long count(const Row& row, std::size_t k, const char* what) const {
    const double value = k < row.numbers.size() ? row.numbers[k] : 0;
    if (row.is_real || !(value >= 1 && value <= 1e6) || value != std::round(value))
      refusals_.fail(row.line, 0, fmt::format("{} must be a whole number above 0", what));
    return static_cast<long long>(value);
  }

  // Returns the first `count` numbers of row `at`. The further numbers of the row only fill the line and must be 0.
  std::vector<double> reals(std::size_t at, std::size_t count, const char* what) const {
    if (at >= rows_.size()) refusals_.fail(fmt::format("the file ends before the {}", what));
    const Row& row = rows_[at];
    if (!row.is_real || row.numbers.size() < count) fail(at, fmt::format("must have {} {}", count, what));
    if (std::any_of(row.numbers.begin() + static_cast<std::ptrdiff_t>(count), row.numbers.end(), [](double v) { return v != 0; }))
      fail(at, fmt::format("must have at most {} {}", count, what));
    return {row.numbers.begin(), row.numbers.begin() + static_cast<std::ptrdiff_t>(count)};
  }

  // Reads the node numbers from row `at` on, ten per line, then the direction of motion of every node in the same form, then
  // the x, y and z positions of all nodes, one row each.
  void read_nodes(NodalModes& made, std::size_t at) {
    std::size_t end = at;
    while (end < rows_.size() && !rows_[end].is_real) ++end;
    const std::size_t lines = end - at;
    if (lines == 0 || lines % 2 != 0) refusals_.fail("the numbers and the directions of the nodes must follow the ranges");
    std::vector<double> numbers, ways;
    for (std::size_t k = 0; k < lines; ++k) {
      std::vector<double>& into = k < lines / 2 ? numbers : ways;
      into.insert(into.end(), rows_[at + k].numbers.begin(), rows_[at + k].numbers.end());
    }
    while (!numbers.empty() && numbers.back() == 0) numbers.pop_back();
    if (numbers.empty() || lines != 2) refusals_.fail("the file must have one to ten nodes");
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] < 1 || i >= ways.size() || (ways[i] != 1 && ways[i] != 2 && ways[i] != 3))
        fail(at, "a node must have a number, and one of the directions 1, 2 and 3");
      directions_.push_back(static_cast<std::size_t>(ways[i]) - 1);
    }
    made.holds = {false, false, false};
    made.holds[directions_.front()] = true;
    if (std::any_of(directions_.begin(), directions_.end(), [&](std::size_t d) { return d != directions_.front(); }))
      fail(at + 1, "all nodes must have the same direction of motion");
    made.nodes.assign(numbers.size(), no_motion);
    for (std::size_t d = 0; d < 3; ++d) {
      const std::vector<double> places = reals(end + d, numbers.size(), "positions");
      for (std::size_t i = 0; i < numbers.size(); ++i) made.nodes[i][d] = places[i];
    }
    at_shapes_ = end + 3;
  }

  Refusals refusals_;
  std::vector<Row> rows_;
  std::vector<std::size_t> directions_;
  std::size_t at_shapes_ = 0, end_ = 0;
};

}  // namespace

bool is_ansys_rom(std::string_view text) { return trimmed(text.substr(0, 40)).starts_with("RELEASE:"); }

NodalModes read_ansys_rom(std::string_view text, const std::string& file) { return RomReader(text, file).read(); }

}  // namespace softland::internal
