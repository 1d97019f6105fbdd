// Reads results of CalculiX (.frd): modes of *FREQUENCY, which CalculiX normalises to a modal mass of 1 in its units.
//
// Numbers are in fixed columns, without blanks between them. A line that begins with " -1" holds the number of a node in 10
// columns (5 in the short format), then values of 12 columns each. Source: CalculiX GraphiX user manual, "Result Format",
// sections "Nodal Point Coordinate Block" and "Nodal Results Block".
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "base/printable.h"
#include "base/shortened.h"
#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/layout.h"
#include "exchange/nodal_modes.h"

namespace softland::internal {
namespace {

constexpr std::size_t number_width = 12, key_width = 3;

class FrdReader {
 public:
  FrdReader(std::string_view text, const std::string& file) : lines_(text), refusals_(file) {}

  NodalModes read() {
    made_.format = "CalculiX .frd";
    while (lines_.next()) {
      if (lines_.line().starts_with("    2C")) {
        read_nodes();
      } else if (lines_.line().starts_with("    1PGM")) {
        modal_mass_ = number(last_word(), "the generalised mass (1PGM)");
      } else if (lines_.line().starts_with("    1PGK")) {
        squared_frequency_ = number(last_word(), "the generalised stiffness (1PGK)");
      } else if (lines_.line().starts_with("  100C")) {
        read_step();
      } else if (lines_.line().starts_with("    3C")) {
        pass_block();
      } else if (lines_.line().starts_with(" 9999")) {
        has_end_ = true;
      } else if (lines_.line().starts_with(" -")) {
        fail("this line belongs to a block (2C, 3C, 100C) whose first line is missing");
      }
    }
    if (!has_end_) made_.left_out.emplace_back("data after the end of the file: the mark 9999 is missing");
    finish();
    return std::move(made_);
  }

 private:
  [[noreturn]] void fail(const std::string& rule) const { refusals_.fail(lines_.number(), 0, rule); }
  [[nodiscard]] std::string_view field(std::size_t begin, std::size_t width) const {
    return begin < lines_.line().size() ? trimmed(lines_.line().substr(begin, width)) : std::string_view();
  }
  [[nodiscard]] std::string_view last_word() const {
    const std::string_view text = trimmed(lines_.line());
    return text.substr(text.find_last_of(' ') + 1);
  }
  [[nodiscard]] double number(std::string_view text, const char* what) const {
    const std::optional<double> value = plain_decimal(text);
    if (!value) fail(fmt::format("{} is \"{}\"; it must be a finite number", what, printable_line(shortened(text, 20))));
    return *value;
  }
  [[nodiscard]] std::size_t whole(std::string_view text, const char* what) const {
    std::size_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size())
      fail(fmt::format("{} is \"{}\"; it must be a whole number", what, printable_line(shortened(text, 20))));
    return value;
  }
  // Returns how many columns the number of a node takes in a block of the format `format`, which the first line of the block
  // names.
  [[nodiscard]] std::size_t node_width(std::string_view format) const {
    if (format == "1") return 10;
    if (format == "0") return 5;
    if (format == "2" || format == "3") fail("the numbers of this block are binary; write the .frd as text");
    fail(fmt::format("the format of the block is \"{}\"; it must be 0 or 1", printable_line(shortened(format, 20))));
  }
  [[nodiscard]] std::size_t node(std::size_t width) const { return whole(field(key_width, width), "the number of the node"); }
  [[nodiscard]] Vector3 vector(std::size_t begin) const {
    // Check the length of the line: one character more or less would shift the columns of all numbers.
    const std::size_t end = begin + 3 * number_width;
    if (lines_.line().size() < end || !trimmed(lines_.line().substr(end)).empty())
      fail(fmt::format("the line of a node must have {} columns, and has {}", end, lines_.line().size()));
    Vector3 v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = number(field(begin + k * number_width, number_width), "a number of the node");
    return v;
  }

  void pass_block() {
    while (lines_.next() && !lines_.line().starts_with(" -3")) continue;
  }

  void read_nodes() {
    if (!indices_.empty()) fail("the file must have a single block of nodes");
    const std::size_t count = whole(field(24, number_width), "the number of nodes"), width = node_width(last_word());
    for (bool ended = false; !ended;) {
      if (!lines_.next()) fail("the file ends within the block of nodes");
      if (lines_.line().starts_with(" -3")) {
        ended = true;
      } else if (lines_.line().starts_with(" -1")) {
        if (!indices_.emplace(node(width), made_.nodes.size()).second) fail("this node is given twice");
        made_.nodes.push_back(vector(key_width + width));
      } else {
        fail("expected a line of a node (-1) or the end of the block (-3)");
      }
    }
    if (made_.nodes.size() != count) fail(fmt::format("the block has {} nodes, but states {}", made_.nodes.size(), count));
  }

  // Reads a block of results. Only the displacements of modes are used; other results are skipped.
  void read_step() {
    constexpr std::string_view modal = "2";
    const bool is_modal = field(56, 2) == modal;
    const double value = number(field(12, number_width), "the frequency");
    const std::size_t count = whole(field(24, number_width), "the number of nodes");
    const std::size_t mode = whole(field(58, 5), "the number of the step");
    const std::string_view format = field(73, 2);
    const std::size_t width = node_width(format);
    if (!lines_.next()) return cut(mode);
    if (!lines_.line().starts_with(" -4")) fail("expected the line of a result (-4)");
    const std::string what(field(5, 8));
    if (!is_modal) static_results_ = true;
    if (is_modal && (modal_steps_.empty() || modal_steps_.back() != mode)) modal_steps_.push_back(mode);
    const bool is_taken = is_modal && what == "DISP";
    if (is_modal && what == "PDISP") fail("displacements must be those of *FREQUENCY, not magnitude and phase");
    if (is_taken && made_.nodes.empty()) fail("the nodes must precede the displacements");
    std::vector<bool> given(made_.nodes.size());
    std::vector<Vector3> motion(is_taken ? made_.nodes.size() : 0, no_motion);
    std::size_t rows = 0;
    for (;;) {
      if (!lines_.next()) return is_taken ? cut(mode) : void();
      if (lines_.line().starts_with(" -3")) break;
      if (!is_taken || lines_.line().starts_with(" -5")) continue;
      if (lines_.is_unended()) return cut(mode);
      if (!lines_.line().starts_with(" -1")) fail("expected a line of a node (-1) or the end of the block (-3)");
      const auto found = indices_.find(node(width));
      if (found == indices_.end()) fail("unknown node");
      if (given[found->second]) fail("this node is given twice");
      given[found->second] = true;
      motion[found->second] = vector(key_width + width);
      ++rows;
    }
    if (!is_taken) return;
    if (rows != count || rows != made_.nodes.size())
      fail(fmt::format("the mode has displacements of {} nodes, but the mesh has {} nodes", rows, made_.nodes.size()));
    check_frequency(value);
    taken_steps_.push_back(mode);
    made_.modes.push_back(
        {.frequency = value, .modal_mass = modal_mass_, .motion = std::move(motion), .name = fmt::format("mode {}", mode)});
  }

  // Checks the frequency of a mode [Hz] against the generalised stiffness of the mode in the line 1PGK, which is the squared
  // angular frequency times the modal mass.
  void check_frequency(double frequency) const {
    constexpr double printed = 1e-4;  // relative rounding error of numbers printed with six digits
    const double angular = 2 * std::numbers::pi * frequency, squared = squared_frequency_ / modal_mass_;
    if (!(frequency >= 0)) fail(fmt::format("the frequency is {}; it must not be negative", frequency));
    if (!std::isnan(squared) && !(std::abs(angular * angular - squared) <= printed * std::abs(squared)))
      fail(fmt::format("the frequency of {} Hz must agree with {} rad/s from the generalised stiffness (1PGK)", frequency,
                       std::sqrt(std::abs(squared))));
  }

  void cut(std::size_t mode) { made_.left_out.push_back(fmt::format("mode {}: the file ends within it", mode)); }

  void finish() {
    if (made_.modes.empty() && made_.left_out.size() < 2) {
      refusals_.fail(static_results_
                         ? "the file holds a static result of CalculiX and no modes; run a step *FREQUENCY with *NODE FILE, U"
                         : "the file holds a mesh of CalculiX and no modes; run a step *FREQUENCY with *NODE FILE, U");
    }
    if (made_.modes.empty()) refusals_.fail("the file ends within the first mode");
    if (static_results_) made_.left_out.emplace_back("results other than modes");
    for (const std::size_t step : modal_steps_) {
      if (std::find(taken_steps_.begin(), taken_steps_.end(), step) == taken_steps_.end())
        made_.left_out.push_back(fmt::format("mode {}: no displacements (DISP)", step));
    }
    const bool all_say = std::all_of(made_.modes.begin(), made_.modes.end(), [](const NodalMode& m) { return m.modal_mass > 0; });
    if (all_say) made_.normalised_by = "the generalised mass of each mode";
  }

  Lines lines_;
  Refusals refusals_;
  NodalModes made_;
  std::unordered_map<std::size_t, std::size_t> indices_;
  double modal_mass_ = std::numeric_limits<double>::quiet_NaN(), squared_frequency_ = modal_mass_;
  std::vector<std::size_t> modal_steps_, taken_steps_;
  bool static_results_ = false, has_end_ = false;
};

}  // namespace

bool is_frd(std::string_view text) {
  constexpr std::size_t looked_at = 8;
  Lines lines(text.substr(0, 4096));
  for (std::size_t i = 0; i < looked_at && lines.next(); ++i) {
    for (const std::string_view begin : {"    1C", "    1U", "    2C"}) {
      if (lines.line().starts_with(begin)) return true;
    }
  }
  return false;
}

NodalModes read_frd(std::string_view text, const std::string& file) { return FrdReader(text, file).read(); }

}  // namespace softland::internal
