// Reads value change dumps (VCD), as logic analysers and simulators of digital circuits write them.
//
// A variable of a dump keeps its value until the next change. Every time of a change becomes two rows of the recording, with
// the values before and after, so that straight lines between rows are steps. Variables with the same identifier have the same
// values.
//
// The states x and z, and the states W, U and '-' of VHDL, become missing numbers. A vector of bits becomes a whole number.
//
// Source: IEEE Std 1364-2005, clause 18.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"
#include "exchange/measure.h"
#include "exchange/parsers.h"

namespace softland::internal {
namespace {

constexpr double missing_number = std::numeric_limits<double>::quiet_NaN();

/// Splits a text into words, which blanks and line ends separate.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  bool next() {
    while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    word_ = text_.substr(begin, at_ - begin);
    return !word_.empty();
  }
  [[nodiscard]] std::string_view word() const { return word_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  /// Returns true if the file ends within the current word or directly after it.
  [[nodiscard]] bool is_unended() const { return at_ == text_.size(); }

 private:
  [[nodiscard]] static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  std::string_view text_, word_;
  std::size_t at_ = 0, line_ = 1;
};

/// A scope (module) of variables in a value change dump, with a link to the enclosing scope.
struct Scope {
  std::size_t around = 0;  ///< index of the enclosing scope; 0: the file
  std::string_view name = {};
  std::size_t length = 0;  ///< length of the path of the scope, in characters
};

struct Variable {
  std::string name;  ///< name of the variable with its range, such as "data[7:0]"
  std::size_t scope = 0, signal = 0;
  bool is_state = false;
};

struct Change {
  std::uint64_t time = 0;  ///< time of a change, in time steps of the file
  double value = missing_number;
};

/// The changes of all variables that share one identifier.
struct DumpedSignal {
  std::vector<Change> changes;
  std::size_t bits = 0;  ///< number of bits of the variable; 0: a real number
  bool has_sign = false, is_wanted = false, is_left_out = false;
};

bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

class VcdReader {
 public:
  VcdReader(std::string_view text, const std::string& file, const ReadKeys& keys) : words_(text), keys_(keys) {
    made_ = {.file = file, .format = "VCD", .has_times = true, .times_have_unit = true, .is_breakpoints = true};
  }
  Recording read() {
    declarations();
    choose();
    changes();
    make_rows();
    return std::move(made_);
  }

 private:
  [[noreturn]] void fail(const std::string& rule) const {
    throw InvalidInput(fmt::format("{}:{}: {}", made_.file, words_.line(), rule));
  }
  [[noreturn]] void fail_at_word(const std::string& rule) const {
    fail(fmt::format("\"{}\" {}", printable_line(shortened(words_.word())), rule));
  }
  /// Reads the words of a section of the file, up to the next keyword $end.
  std::vector<std::string_view> words_to_end() {
    std::vector<std::string_view> all;
    while (words_.next() && words_.word() != "$end") all.push_back(words_.word());
    if (words_.word() != "$end") fail("the file ends before the $end of a section");
    return all;
  }

  void declarations();
  void set_timescale(const std::vector<std::string_view>& words);
  void declare(const std::vector<std::string_view>& words);
  void choose();
  [[nodiscard]] std::string path(const Variable& variable) const;
  [[nodiscard]] bool is_called(const Variable& variable, std::string_view name) const;

  void changes();
  void take_word();
  void take_time();
  void change(std::string_view identifier, double value);
  [[nodiscard]] DumpedSignal& signal_of(std::string_view identifier);
  [[nodiscard]] double vector_value(std::string_view digits, const DumpedSignal& signal) const;

  void make_rows();
  [[nodiscard]] double seconds(std::uint64_t time) const { return static_cast<double>(time) * steps_ / per_second_; }

  Words words_;
  const ReadKeys& keys_;
  Recording made_;
  double steps_ = 0, per_second_ = 1;  // a time step of the file is steps_ / per_second_ [s]
  std::vector<Scope> scopes_{Scope{}};
  std::size_t scope_ = 0;
  std::vector<Variable> variables_;
  std::vector<DumpedSignal> signals_;
  std::unordered_map<std::string_view, std::size_t> identifiers_;
  std::vector<std::size_t> chosen_;  // indices of the variables that become channels of the recording

  bool has_begun_ = false;
  std::uint64_t first_ = 0, now_ = 0;
  struct Moment {
    std::uint64_t time;
    std::uint32_t line;
  };
  std::vector<Moment> moments_;  // times at which variables change, in order
};

void VcdReader::declarations() {
  while (words_.next()) {
    const std::string_view word = words_.word();
    if (!word.starts_with('$')) fail_at_word("must be a declaration, such as $scope or $var");
    const std::vector<std::string_view> said = words_to_end();
    if (word == "$enddefinitions") return;
    if (word == "$timescale") set_timescale(said);
    if (word == "$var") declare(said);
    if (word == "$scope") {
      const std::string_view name = said.empty() ? std::string_view() : said.back();
      scopes_.push_back({.around = scope_, .name = name, .length = scopes_[scope_].length + name.size() + 1});
      scope_ = scopes_.size() - 1;
    }
    if (word == "$upscope") {
      if (scope_ == 0) fail("$upscope must follow the $scope that it ends");
      scope_ = scopes_[scope_].around;
    }
  }
  fail("the file ends within its declarations, before $enddefinitions");
}

void VcdReader::set_timescale(const std::vector<std::string_view>& words) {
  constexpr std::array<std::pair<std::string_view, double>, 6> units{
      {{"s", 1}, {"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}, {"ps", 1e12}, {"fs", 1e15}}};
  std::string text;
  for (const std::string_view word : words) text += word;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), steps_);
  const std::string_view unit = std::string_view(text).substr(static_cast<std::size_t>(stop - text.data()));
  const auto known = std::ranges::find(units, unit, &std::pair<std::string_view, double>::first);
  if (error != std::errc() || known == units.end() || !(steps_ > 0) || !(steps_ <= 1e6))
    fail(fmt::format("$timescale {}: must be a time such as 1 ns, in s, ms, us, ns, ps or fs", printable_line(shortened(text))));
  per_second_ = known->second;
}

// Reads the words of $var: type, number of bits, identifier, and name; a range may follow the name as a word of its own.
void VcdReader::declare(const std::vector<std::string_view>& words) {
  std::size_t bits = 0;
  if (words.size() < 4 || std::from_chars(words[1].data(), words[1].data() + words[1].size(), bits).ec != std::errc())
    fail("a variable must be declared as $var TYPE BITS IDENTIFIER NAME $end");
  const std::string_view type = words[0];
  const bool is_real = type.find("real") != std::string_view::npos;
  const auto [place, is_new] = identifiers_.try_emplace(words[2], signals_.size());
  if (is_new)
    signals_.push_back({.changes = {},
                        .bits = is_real ? 0 : bits,
                        .has_sign = type == "integer",
                        .is_left_out = type == "event" || type == "string"});
  Variable variable{.name = {}, .scope = scope_, .signal = place->second, .is_state = bits == 1 && !is_real};
  for (std::size_t i = 3; i < words.size(); ++i) variable.name += words[i];
  variables_.push_back(std::move(variable));
}

// Returns the path of a variable, such as "top.counter.clk".
std::string VcdReader::path(const Variable& variable) const {
  std::vector<std::string_view> names;
  for (std::size_t scope = variable.scope; scope != 0; scope = scopes_[scope].around) names.push_back(scopes_[scope].name);
  std::string path;
  for (std::size_t i = names.size(); i-- > 0;) path.append(names[i]).append(".");
  return path + variable.name;
}

bool VcdReader::is_called(const Variable& variable, std::string_view name) const {
  return variable.name == name ||
         (scopes_[variable.scope].length + variable.name.size() == name.size() && path(variable) == name);
}

// Selects the variables that the user's keys name, or all variables.
void VcdReader::choose() {
  if (steps_ == 0) {
    if (keys_.time_unit.empty()) fail("the file has no $timescale; give the unit of the times, such as time_unit = \"ns\"");
    set_timescale({"1", keys_.time_unit});
  }
  const auto number = static_cast<std::size_t>(keys_.column_number);
  for (std::size_t k = 0; k < variables_.size(); ++k) {
    if (number > 0 ? k + 1 == number : !keys_.column.empty() && is_called(variables_[k], keys_.column)) chosen_.push_back(k);
  }
  if (chosen_.empty()) {
    chosen_.resize(variables_.size());
    std::iota(chosen_.begin(), chosen_.end(), std::size_t{0});
  }
  for (const std::size_t k : chosen_) signals_[variables_[k].signal].is_wanted = true;
}

void VcdReader::changes() {
  constexpr const char* cut = "the last line has no line end: its last change may have been cut";
  while (words_.next()) {
    try {
      take_word();
    } catch (const InvalidInput&) {
      if (!words_.is_unended()) throw;
      made_.left_out.emplace_back("the last change, within which the file ends");
      return;
    }
    if (words_.is_unended()) made_.notes.emplace_back(cut);
  }
}

void VcdReader::take_word() {
  const std::string_view word = words_.word();
  constexpr std::array<std::string_view, 5> sections{"$dumpvars", "$dumpall", "$dumpon", "$dumpoff", "$end"};
  switch (word.front()) {
    case '#':
      return take_time();
    case '$':
      if (std::ranges::find(sections, word) == sections.end()) words_to_end();
      return;
    case '1':
    case 'H':
    case 'h':
      return change(word.substr(1), 1);
    case '0':
    case 'L':
    case 'l':
      return change(word.substr(1), 0);
    case 'b':
    case 'B':
    case 'r':
    case 'R':
    case 's':
    case 'S':
      break;
    default:
      if (std::string_view("xXzZuUwW-").find(word.front()) != std::string_view::npos)
        return change(word.substr(1), missing_number);
      fail_at_word("must be a time, such as #100, or a change, such as 1! or b101 !");
  }
  if (!words_.next())
    fail(fmt::format("\"{}\" must be followed by the identifier of a variable", printable_line(shortened(word))));
  const std::string_view digits = word.substr(1);
  double value = missing_number;
  if (word.front() == 'b' || word.front() == 'B') {
    value = vector_value(digits, signal_of(words_.word()));
  } else if (word.front() == 'r' || word.front() == 'R') {
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool is_number = error == std::errc() && stop == digits.data() + digits.size();
    if (!is_number && digits != "x" && digits != "z")
      fail(fmt::format("\"{}\" must be r followed by a number", printable_line(shortened(word))));
    if (!is_number || !std::isfinite(value)) value = missing_number;
  } else {
    signal_of(words_.word()).is_left_out = true;
  }
  change(words_.word(), value);
}

void VcdReader::take_time() {
  const std::string_view digits = words_.word().substr(1);
  std::uint64_t time = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), time);
  if (error != std::errc() || stop != digits.data() + digits.size()) fail_at_word("must be a time, a whole number below 2^64");
  if (!has_begun_) {
    // Values that the file gives before its first time hold from this time on.
    for (DumpedSignal& signal : signals_)
      for (Change& change : signal.changes) change.time = time;
    moments_.assign(1, {.time = time, .line = static_cast<std::uint32_t>(words_.line())});
  }
  if (has_begun_ && time < now_) fail_at_word(fmt::format("is before #{}: times must not decrease", now_));
  if (!std::exchange(has_begun_, true)) first_ = time;
  now_ = time;
}

DumpedSignal& VcdReader::signal_of(std::string_view identifier) {
  const auto found = identifiers_.find(identifier);
  if (found == identifiers_.end())
    fail(fmt::format("\"{}\" must be declared by $var before it changes", printable_line(shortened(identifier))));
  return signals_[found->second];
}

// Returns the number that the bits of a vector represent; NaN if a bit is unknown.
double VcdReader::vector_value(std::string_view digits, const DumpedSignal& signal) const {
  double value = 0;
  for (const char c : digits) {
    const bool is_bit = c == '0' || c == '1';
    if (!is_bit && std::string_view("xXzZuUwW-lLhH").find(c) == std::string_view::npos)
      fail(fmt::format("\"b{}\" must be bits, 0, 1, x and z", printable_line(shortened(digits))));
    value = is_bit ? 2 * value + (c - '0') : missing_number;
  }
  if (signal.has_sign && digits.size() == signal.bits && digits.front() == '1')
    value -= std::exp2(static_cast<double>(digits.size()));
  return std::isfinite(value) ? value : missing_number;
}

// Stores a change of a variable at the current time. If it changes several times at one time, the last change is used.
void VcdReader::change(std::string_view identifier, double value) {
  DumpedSignal& signal = signal_of(identifier);
  if (!signal.is_wanted) return;
  std::vector<Change>& all = signal.changes;
  if (!all.empty() && all.back().time == now_) {
    all.back().value = value;
  } else if (!is_same(all.empty() ? missing_number : all.back().value, value)) {
    all.push_back({.time = now_, .value = value});
    if (has_begun_ && moments_.back().time != now_)
      moments_.push_back({.time = now_, .line = static_cast<std::uint32_t>(words_.line())});
  }
}

void VcdReader::make_rows() {
  if (!has_begun_) fail("the file must have a time, such as #0, below the declarations");
  std::erase_if(chosen_, [&](std::size_t k) { return signals_[variables_[k].signal].is_left_out; });
  std::unordered_map<std::string_view, std::size_t> names;
  std::size_t left_out = 0;
  for (const Variable& variable : variables_) {
    if (signals_[variable.signal].is_left_out)
      ++left_out;
    else
      ++names[variable.name];
  }
  if (left_out > 0) made_.left_out.push_back(fmt::format("{} variables that are text or events", left_out));
  if (chosen_.empty()) fail("the file must have a variable that is a number");

  const bool goes_on = now_ > moments_.back().time;
  const std::size_t rows = 2 * moments_.size() - 1 + (goes_on ? 1 : 0);
  constexpr std::size_t most_bytes = std::size_t{1} << 29, of_channel = sizeof(Channel);
  std::size_t bytes = 0;
  for (const std::size_t k : chosen_) {
    bytes += sizeof(double) * rows + of_channel + 2 * (scopes_[variables_[k].scope].length + variables_[k].name.size());
    require(bytes <= most_bytes, [&] {
      const std::string name = names[variables_[k].name] > 1 ? path(variables_[k]) : variables_[k].name;
      return fmt::format("{}: {} variables that change at {} times are too many to read; select one, such as column = \"{}\"",
                         made_.file, chosen_.size(), moments_.size(), printable_line(shortened(name)));
    });
  }
  for (std::size_t m = 0; m < moments_.size(); ++m) {
    for (int side = m == 0 ? 1 : 0; side < 2; ++side) {
      made_.times.push_back(seconds(moments_[m].time));
      made_.lines.push_back(moments_[m].line);
    }
  }
  if (goes_on) {
    made_.times.push_back(seconds(now_));
    made_.lines.push_back(static_cast<std::uint32_t>(words_.line()));
  }
  std::size_t unknown = 0, wide = 0;
  constexpr std::size_t exact_bits = 53;
  for (const std::size_t k : chosen_) {
    const Variable& variable = variables_[k];
    const DumpedSignal& signal = signals_[variable.signal];
    Channel channel{
        .name = variable.name, .heading = path(variable), .unit = {}, .column = static_cast<int>(k + 1), .values = {}};
    if (names[variable.name] > 1) channel.name = channel.heading;
    channel.is_state = variable.is_state;
    if (const std::optional<Unit> unit = heading_of(variable.name).unit; unit && signal.bits == 0) {
      channel.unit = unit->symbol;
      channel.is_voltage = unit->measure == Measure::voltage;
      channel.per_si = unit->per_si;
    }
    channel.values.reserve(rows);
    double value = missing_number;
    auto next = signal.changes.begin();
    for (std::size_t m = 0; m < moments_.size(); ++m) {
      if (m > 0) channel.values.push_back(value);
      if (next != signal.changes.end() && next->time == moments_[m].time) value = next++->value;
      channel.values.push_back(value);
    }
    if (goes_on) channel.values.push_back(value);
    for (std::size_t row = 0; row < rows; ++row) {
      if (!std::isnan(channel.values[row])) continue;
      if (channel.missing.count++ == 0) channel.missing.line = made_.lines[row];
    }
    unknown += channel.missing.count > 0;
    wide += signal.bits > exact_bits;
    made_.channels.push_back(std::move(channel));
  }
  if (unknown > 0)
    made_.notes.push_back(fmt::format("x and z are missing numbers, in {} of {} channels", unknown, chosen_.size()));
  if (wide > 0) made_.notes.push_back(fmt::format("numbers of more than {} bits are rounded", exact_bits));
}

}  // namespace

bool is_vcd(std::string_view text) {
  constexpr std::array<std::string_view, 8> first{"$date",  "$version", "$comment", "$timescale",
                                                  "$scope", "$var",     "$upscope", "$enddefinitions"};
  Words words(text);
  return words.next() && std::ranges::find(first, words.word()) != first.end();
}

Recording read_vcd(std::string_view text, const std::string& file, const ReadKeys& keys) {
  return VcdReader(text, file, keys).read();
}

}  // namespace softland::internal
