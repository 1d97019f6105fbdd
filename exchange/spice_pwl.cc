#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"
#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/parsers.h"

namespace softland::internal {
namespace {

struct Token {
  std::string_view text;
  std::size_t line = 0;
};

/// A number in the syntax of SPICE. Letters after the digits are a scale suffix, or a unit, which is ignored.
struct SpiceNumber {
  double value = 0;
  bool has_suffix = false;
  bool has_plus = false;
};

// A scale suffix of SPICE as an exact multiplier and an exact divisor, so that 199.999m becomes the double nearest to 0.199999.
struct Suffix {
  std::string_view word;
  double times, over;
};
constexpr std::array suffixes{Suffix{"meg", 1e6, 1}, Suffix{"mil", 25.4, 1e6}, Suffix{"t", 1e12, 1}, Suffix{"g", 1e9, 1},
                              Suffix{"k", 1e3, 1},   Suffix{"m", 1, 1e3},      Suffix{"u", 1, 1e6},  Suffix{"n", 1, 1e9},
                              Suffix{"p", 1, 1e12},  Suffix{"f", 1, 1e15},     Suffix{"a", 1, 1e18}, Suffix{"\xC2\xB5", 1, 1e6}};

std::optional<SpiceNumber> spice_number(std::string_view text) {
  SpiceNumber number;
  if (text.starts_with('+')) {
    number.has_plus = true;
    text.remove_prefix(1);
    if (text.starts_with('-') || text.starts_with('+')) return std::nullopt;
  }
  if (text.empty() || std::isalpha(static_cast<unsigned char>(text.front())) != 0) return std::nullopt;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number.value);
  if (error != std::errc() || !std::isfinite(number.value)) return std::nullopt;
  const std::string rest = lower_case(text.substr(static_cast<std::size_t>(stop - text.data())));
  const bool is_word = std::all_of(rest.begin(), rest.end(), [](unsigned char c) { return std::isalpha(c) != 0 || c > 127; });
  if (!is_word) return std::nullopt;
  for (const Suffix& suffix : suffixes) {
    if (!rest.starts_with(suffix.word)) continue;
    number.value = number.value * suffix.times / suffix.over;
    number.has_suffix = true;
    break;
  }
  number.has_suffix |= !rest.empty();
  return number;
}

bool is_comment(std::string_view line) {
  return line.starts_with('*') || line.starts_with(';') || line.starts_with('#') || line.starts_with("//");
}

std::string_view without_comment(std::string_view line) {
  line = trimmed(line);
  if (is_comment(line)) return {};
  return trimmed(line.substr(0, line.find_first_of(";$")));
}

void add_tokens(std::string_view line, std::size_t number, std::vector<Token>& tokens) {
  constexpr std::string_view between = " \t,";
  for (std::size_t begin = line.find_first_not_of(between); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t,", begin), line.size());
    tokens.push_back({line.substr(begin, end - begin), number});
    begin = line.find_first_not_of(between, end);
  }
}

// Removes the mark of a SPICE continuation line, a plus and a blank. Without the blank, as in "+1u 5", the plus means a time
// relative to the time before.
std::string_view without_continuation(std::string_view line) {
  return line.starts_with("+ ") || line.starts_with("+\t") || line == "+" ? trimmed(line.substr(1)) : line;
}

/// The numbers between the brackets of one PWL( ) source of a SPICE netlist.
struct Source {
  std::string name;
  std::vector<Token> tokens;
};

class NetlistReader {
 public:
  NetlistReader(std::string_view text, const std::string& file) : lines_(text), file_(file) {}
  std::vector<Source> sources() {
    while (lines_.next()) take(lines_.line());
    require(!is_open_,
            [&] { return fmt::format("{}: the file ends within PWL( of \"{}\"", file_, printable_line(found_.back().name)); });
    return std::move(found_);
  }
  [[nodiscard]] const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  void take(std::string_view given) {
    const std::string_view line = without_comment(given);
    if (is_open_) tell_numbers_in_comment(given, line);
    if (line.empty()) return;
    if (is_open_) return take_numbers(without_continuation(line));
    const bool continues = line.starts_with('+');
    const std::string small = lower_case(line);
    if (small.starts_with(".subckt")) {
      const std::string_view rest = trimmed(line.substr(std::min(line.find_first_of(" \t"), line.size())));
      subcircuit_ = std::string(rest.substr(0, rest.find_first_of(" \t")));
    }
    if (small.starts_with(".ends")) subcircuit_.clear();
    if (!continues)
      name_ = (subcircuit_.empty() ? "" : subcircuit_ + ".") + std::string(line.substr(0, line.find_first_of(" \t")));
    const std::size_t at = small.find("pwl");
    if (at == std::string::npos) return;
    const std::size_t open = line.find_first_not_of(" \t", at + 3);
    require(open != std::string_view::npos && line[open] == '(', [&] {
      return fmt::format("{}:{}: \"{}\": PWL must be followed by numbers in brackets", file_, lines_.number(),
                         printable_line(shortened(line)));
    });
    found_.push_back({.name = name_, .tokens = {}});
    is_open_ = true;
    tell_numbers_in_comment(given, line);
    take_numbers(line.substr(open + 1));
  }
  // Adds a note if a comment in a PWL source begins with a number: the user may have meant points of the source.
  void tell_numbers_in_comment(std::string_view given, std::string_view line) {
    std::string_view comment = trimmed(given);
    comment.remove_prefix(line.size());
    comment = trimmed(comment.substr(std::min(comment.find_first_not_of("*;#$/+, "), comment.size())));
    const bool is_number = spice_number(comment.substr(0, comment.find_first_of(" ,\t"))).has_value();
    if (is_number) left_out_.push_back(fmt::format("numbers in a comment in line {}", lines_.number()));
  }
  void take_numbers(std::string_view line) {
    const std::size_t close = line.find(')');
    add_tokens(line.substr(0, close), lines_.number(), found_.back().tokens);
    if (close == std::string_view::npos) return;
    is_open_ = false;
    const std::string_view rest = trimmed(line.substr(close + 1));
    require(rest.empty() || is_comment(rest), [&] {
      return fmt::format("{}:{}: \"{}\" must not follow the numbers of PWL: only points are read", file_, lines_.number(),
                         printable_line(shortened(rest)));
    });
  }

  Lines lines_;
  const std::string& file_;
  std::vector<Source> found_;
  std::vector<std::string> left_out_;
  std::string name_, subcircuit_;
  bool is_open_ = false;
};

bool has_pwl_bracket(std::string_view text) {
  const std::string begin = lower_case(text.substr(0, 1 << 16));
  for (std::size_t at = begin.find("pwl"); at != std::string::npos; at = begin.find("pwl", at + 3)) {
    const std::size_t next = begin.find_first_not_of(" \t", at + 3);
    if (next != std::string::npos && begin[next] == '(') return true;
  }
  return false;
}

Recording points_of(const Source& source, const std::string& file) {
  Recording made{.file = file, .format = "SPICE PWL", .has_times = true, .times_have_unit = true, .is_breakpoints = true};
  Channel channel{.name = source.name.empty() ? "V" : source.name,
                  .heading = source.name,
                  .unit = "V",
                  .is_voltage = true,
                  .column = 2,
                  .values = {}};
  const auto fail = [&](const Token& token, const std::string& rule) {
    throw InvalidInput(fmt::format("{}:{}: \"{}\" {}", file, token.line, printable_line(shortened(token.text)), rule));
  };
  require(!source.tokens.empty(), [&] { return fmt::format("{}: a source must have points", file); });
  bool is_signed = false;
  for (std::size_t i = 0; i < source.tokens.size(); i += 2) is_signed |= source.tokens[i].text.starts_with('-');
  for (std::size_t i = 0; i < source.tokens.size(); i += 2) {
    const Token& at = source.tokens[i];
    const std::optional<SpiceNumber> time = spice_number(at.text);
    if (!time) fail(at, "must be a time, such as 1.5u");
    if (i + 1 == source.tokens.size()) fail(at, "is a time without a voltage: each point must have two numbers");
    const Token& level = source.tokens[i + 1];
    const std::optional<SpiceNumber> volts = spice_number(level.text);
    if (!volts) fail(level, "must be a voltage, such as 5 or 120m");
    const double before = made.times.empty() ? 0 : made.times.back();
    made.times.push_back(time->has_plus && !is_signed ? before + time->value : time->value);
    made.lines.push_back(static_cast<std::uint32_t>(at.line));
    channel.values.push_back(volts->value);
  }
  made.channels.push_back(std::move(channel));
  return made;
}

/// The times in a text of two numbers per line, to distinguish a PWL source from recorded columns with rounded times.
struct PlainTimes {
  std::vector<double> all;
  std::size_t repeated = 0;  ///< number of rows with the same time as the row before
  bool thrice = false;       ///< true if three rows have the same time

  void take(double time) {
    const std::size_t count = all.size();
    const bool repeats = count > 0 && all[count - 1] == time;
    repeated += repeats;
    thrice |= repeats && count > 1 && all[count - 2] == time;
    all.push_back(time);
  }
  // Returns true if the times seem rounded, as those of recorded columns may be: three rows have equal time, or every time
  // occurs twice. In a PWL source, a voltage jump has two rows of equal time.
  [[nodiscard]] bool are_rounded() const {
    constexpr std::size_t fewest = 8;
    return thrice || (all.size() >= fewest && 2 * repeated + 1 >= all.size());
  }
};

}  // namespace

// Returns true for a netlist with PWL( ). Returns true for lines of time and value that are more likely a PWL source than
// recorded columns: they have scale suffixes, continuation lines or relative times, or their times are not rounded. Times are
// relative if some have a plus and others have no sign. A plus before all times, or beside negative times, is a mere sign.
bool is_spice_pwl(std::string_view text) {
  constexpr std::size_t enough = 64;
  if (has_pwl_bracket(text)) return true;
  Lines lines(text);
  std::vector<Token> tokens;
  bool has_suffix = false, has_continuation = false, has_comma = false, has_bare_time = false;
  std::size_t rows = 0, pluses = 0, minuses = 0;
  PlainTimes times;
  while (rows < enough && lines.next()) {
    const std::string_view line = without_comment(lines.line());
    if (line.empty()) continue;
    const std::string_view rest = without_continuation(line);
    has_continuation |= rest.size() != line.size();
    has_comma |= rest.find(',') != std::string_view::npos;
    tokens.clear();
    add_tokens(rest, lines.number(), tokens);
    if (tokens.size() % 2 != 0 || (tokens.size() != 2 && !has_continuation)) return false;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      const std::optional<SpiceNumber> number = spice_number(tokens[i].text);
      if (!number) return false;
      has_suffix |= number->has_suffix;
      if (i % 2 != 0) continue;
      pluses += number->has_plus;
      minuses += tokens[i].text.starts_with('-');
      has_bare_time |= !number->has_plus && !tokens[i].text.starts_with('-');
      times.take(number->value);
    }
    ++rows;
  }
  if (rows == 0) return false;
  if (has_suffix || has_continuation) return true;
  if (has_comma || (pluses > 0 && (minuses > 0 || !has_bare_time))) return false;
  return pluses > 0 || !times.are_rounded();
}

Recording read_spice_pwl(std::string_view text, const std::string& file, const ReadKeys& keys) {
  if (!has_pwl_bracket(text)) {
    Source source;
    Lines lines(text);
    bool ends_unended = false;
    while (lines.next()) {
      if (lines.number() <= static_cast<std::size_t>(keys.skip)) continue;
      const std::size_t before = source.tokens.size();
      const std::string_view line = without_continuation(without_comment(lines.line()));
      add_tokens(line, lines.number(), source.tokens);
      ends_unended = lines.is_unended() && !line.empty();
      const bool is_odd = (source.tokens.size() - before) % 2 != 0;
      const bool is_cut = lines.is_unended() && is_odd;
      require(!is_cut, [&] { return fmt::format("{}:{}: the file ends in the middle of a row", file, lines.number()); });
      require(!is_odd, [&] {
        return fmt::format("{}:{}: the row has {} numbers; each point must have two", file, lines.number(),
                           source.tokens.size() - before);
      });
    }
    Recording made = points_of(source, file);
    if (ends_unended) made.notes.emplace_back("the last line has no line end: its last number may have been cut");
    return made;
  }
  NetlistReader reader(text, file);
  const std::vector<Source> sources = reader.sources();
  const auto chosen = std::find_if(sources.begin(), sources.end(),
                                   [&](const Source& source) { return lower_case(source.name) == lower_case(keys.column); });
  require(chosen != sources.end() || sources.size() == 1, [&] {
    std::string names;
    for (const Source& source : sources) names += (names.empty() ? "" : ", ") + printable_line(source.name);
    return fmt::format("{}: the file has {} sources ({}); select one, such as column = \"{}\"", file, sources.size(), names,
                       printable_line(sources.empty() ? std::string() : sources.front().name));
  });
  Recording made = points_of(chosen != sources.end() ? *chosen : sources.front(), file);
  made.left_out = reader.left_out();
  return made;
}

}  // namespace softland::internal
