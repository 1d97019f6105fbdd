#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
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
#include "exchange/measure.h"
#include "exchange/parsers.h"
#include "exchange/time_axis.h"

namespace softland::internal {
namespace {

constexpr std::size_t header_lines = 11;
constexpr std::string_view end_mark = "    -1";

/// Names of the kinds of functions that a data set 58 can hold; the index is the function-type number in the file.
constexpr std::array function_names{"a general or unknown function",
                                    "a time response",
                                    "an auto spectrum",
                                    "a cross spectrum",
                                    "a frequency response function",
                                    "a transmissibility",
                                    "a coherence",
                                    "an auto correlation",
                                    "a cross correlation",
                                    "a power spectral density",
                                    "an energy spectral density",
                                    "a probability density function",
                                    "a spectrum",
                                    "a cumulative frequency distribution"};

/// Reads the bytes of a file line by line, and binary data as a whole.
class Reader {
 public:
  Reader(std::string_view bytes, const std::string& file) : rest_(bytes), file_(file) {}
  [[nodiscard]] bool at_end() const { return rest_.empty(); }
  [[nodiscard]] std::size_t line_number() const { return number_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }
  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    is_cut_ = end == std::string_view::npos;
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }
  void skip(std::size_t bytes) { rest_.remove_prefix(std::min(bytes, rest_.size())); }
  /// Returns true if the last line ends with the file, without a line end.
  [[nodiscard]] bool is_cut() const { return is_cut_; }
  [[noreturn]] void fail(const std::string& rule) const { throw InvalidInput(fmt::format("{}:{}: {}", file_, number_, rule)); }

 private:
  std::string_view rest_;
  const std::string& file_;
  std::size_t number_ = 0;
  bool is_cut_ = false;
};

bool is_mark(std::string_view line) { return trimmed(line) == "-1"; }

struct Header {
  std::array<std::string_view, header_lines> lines;
  bool is_binary = false, is_big_endian = false;
  std::size_t bytes = 0;
  int function = 0, type = 0;
  std::size_t count = 0;
  bool is_even = true;
  double first = 0, step = 0;
  std::string label, unit, time_unit;
  [[nodiscard]] bool is_double() const { return type == 4 || type == 6; }
  [[nodiscard]] bool is_complex() const { return type == 5 || type == 6; }
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  split_cells(line, ' ', words);
  return words;
}

long long whole(const Reader& in, std::string_view text, std::string_view what) {
  long long value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size())
    in.fail(fmt::format("{} is \"{}\"; it must be a whole number", what, printable_line(shortened(text, 20))));
  return value;
}

double real(const Reader& in, std::string_view text, std::string_view what) {
  const std::optional<double> value = plain_decimal(text);
  if (!value) in.fail(fmt::format("{} is \"{}\"; it must be a finite number", what, printable_line(shortened(text, 20))));
  return *value;
}

// Returns the label and the unit of an axis from columns 27 to 46 and 48 to 67 of its line in the header; empty for NONE.
std::pair<std::string, std::string> axis_prose(std::string_view line) {
  const auto field = [&](std::size_t from) {
    return from < line.size() ? std::string(trimmed(line.substr(from, 20))) : std::string();
  };
  std::pair<std::string, std::string> words{field(26), field(47)};
  for (std::string* word : {&words.first, &words.second}) {
    if (*word == "NONE") word->clear();
  }
  return words;
}

Header read_header(Reader& in, std::string_view first_line) {
  Header header;
  const std::vector<std::string_view> kind = words_of(first_line);
  header.is_binary = kind.front().ends_with('b') || kind.front().ends_with('B');
  if (header.is_binary) {
    if (kind.size() < 5) in.fail("the first line of a data set 58b must name byte order, format of numbers, lines and bytes");
    const long long order = whole(in, kind[1], "the byte order"), format = whole(in, kind[2], "the format of numbers");
    if (order != 1 && order != 2)
      in.fail(fmt::format("the byte order is {}; it must be 1 (little endian) or 2 (big endian)", order));
    if (format != 2) in.fail(fmt::format("the format of numbers is {}; only 2 (IEEE 754) is read", format));
    if (whole(in, kind[3], "the number of lines") != static_cast<long long>(header_lines))
      in.fail("a data set 58b must have 11 lines above its numbers");
    const long long bytes = whole(in, kind[4], "the number of bytes");
    if (bytes < 0) in.fail("the number of bytes must not be negative");
    header.is_big_endian = order == 2;
    header.bytes = static_cast<std::size_t>(bytes);
  }
  std::size_t taken = 0;
  for (; taken < header_lines && !in.at_end(); ++taken) {
    header.lines[taken] = in.line();
    if (taken == 5) {
      const std::vector<std::string_view> words = words_of(header.lines[taken]);
      if (words.empty()) in.fail("the line of the function is empty");
      header.function = static_cast<int>(whole(in, words[0], "the type of the function"));
    } else if (taken == 6) {
      const std::vector<std::string_view> words = words_of(header.lines[taken]);
      if (words.size() < 5)
        in.fail("the line of the data must name type, number of values, spacing, first abscissa and increment");
      header.type = static_cast<int>(whole(in, words[0], "the type of the numbers"));
      const long long count = whole(in, words[1], "the number of values");
      if (count < 1) in.fail(fmt::format("the number of values is {}; it must be above 0", count));
      header.count = static_cast<std::size_t>(count);
      const long long spacing = whole(in, words[2], "the spacing");
      if (spacing != 0 && spacing != 1) in.fail(fmt::format("the spacing is {}; it must be 0 (uneven) or 1 (even)", spacing));
      header.is_even = spacing == 1;
      header.first = real(in, words[3], "the first abscissa");
      header.step = real(in, words[4], "the increment of the abscissa");
    } else if (taken == 7) {
      header.time_unit = axis_prose(header.lines[taken]).second;
    } else if (taken == 8) {
      std::tie(header.label, header.unit) = axis_prose(header.lines[taken]);
    }
  }
  if (taken < header_lines) in.fail("the file ends before the numbers of a data set 58");
  return header;
}

void refuse_other_functions(const Reader& in, const Header& header) {
  const auto known = static_cast<std::size_t>(std::max(header.function, 0));
  if (header.function > 1 || header.function < 0)
    in.fail(fmt::format("the data set holds {} (function type {}); give a record over time",
                        known < function_names.size() ? function_names[known] : "a function of another kind", header.function));
  if (header.is_complex()) in.fail("the numbers are complex; give a record over time");
  if (header.type != 2 && header.type != 4)
    in.fail(fmt::format("the type of the numbers is {}; it must be 2 or 4 (real)", header.type));
  if (header.is_even && !(header.step > 0))
    in.fail(fmt::format("the increment of the abscissa is {}; it must be above 0", header.step));
  const std::optional<Unit> unit = unit_of(header.time_unit);
  if (unit && unit->measure != Measure::time)
    in.fail(fmt::format("the abscissa is in {}; give a record over time", unit->symbol));
}

// Reads up to `due` numbers of a data set in text form. There may be no blank between numbers if the second has a sign.
std::vector<double> ascii_numbers(Reader& in, std::size_t due, std::vector<std::string>& left_out) {
  std::vector<double> numbers;
  numbers.reserve(std::min<std::size_t>(due, in.rest().size() / 6 + 1));
  bool ended = false;
  while (!in.at_end()) {
    const std::string_view line = in.line();
    if (is_mark(line)) {
      ended = true;
      break;
    }
    std::string text(line);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == 'D' || c == 'd'; }, 'E');
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
      while (at != end && (*at == ' ' || *at == '\t')) ++at;
      if (at == end) break;
      if (*at == '+') ++at;
      double value = 0;
      const auto [stop, error] = std::from_chars(at, end, value);
      const bool is_number = error == std::errc() && std::isfinite(value) &&
                             (stop == end || *stop == ' ' || *stop == '-' || *stop == '+' || *stop == '\t');
      if (!is_number && in.is_cut()) break;
      if (!is_number)
        in.fail(
            fmt::format("column {}: \"{}\" must be a finite number", at - text.data() + 1, printable_line(shortened(at, 20))));
      numbers.push_back(value);
      at = stop;
    }
  }
  if (numbers.size() > due) in.fail(fmt::format("there are {} numbers, but the data set states {}", numbers.size(), due));
  if (!ended && !numbers.empty() && numbers.size() <= due) {
    numbers.pop_back();
    left_out.push_back(
        fmt::format("the last number: the file ends without its end mark, after {} of {} numbers", numbers.size(), due));
  } else if (numbers.size() < due) {
    in.fail(fmt::format("there are {} numbers, but the data set states {}", numbers.size(), due));
  }
  return numbers;
}

double binary_number(std::string_view bytes, bool big_endian) {
  std::array<char, 8> raw{};
  std::copy(bytes.begin(), bytes.end(), raw.begin());
  if (big_endian) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(bytes.size()));
  if (bytes.size() == 4) {
    float single = 0;
    std::memcpy(&single, raw.data(), sizeof single);
    return static_cast<double>(single);
  }
  double value = 0;
  std::memcpy(&value, raw.data(), sizeof value);
  return value;
}

struct Values {
  std::vector<double> abscissas, ordinates;  // abscissas (times) and ordinates; abscissas are empty if evenly spaced
};

Values binary_values(Reader& in, const Header& header, std::vector<std::string>& left_out) {
  const std::size_t size = header.is_double() ? 8 : 4;
  if (header.count > header.bytes / size)
    in.fail(fmt::format("{} bytes cannot hold {} values of {} bytes", header.bytes, header.count, size));
  // In binary data with unevenly spaced abscissas, an abscissa has four bytes in some files and as many as an ordinate in
  // others.
  const std::size_t row = header.bytes / header.count, abscissa = row - size;
  const bool fits = row * header.count == header.bytes && (header.is_even ? abscissa == 0 : abscissa == 4 || abscissa == size);
  if (!fits) in.fail(fmt::format("{} bytes do not hold {} values of {} bytes", header.bytes, header.count, size));
  const std::string_view data = in.rest().substr(0, header.bytes);
  const std::size_t whole_rows = data.size() / row;
  Values values;
  for (std::size_t i = 0; i < whole_rows; ++i) {
    const std::string_view bytes = data.substr(i * row, row);
    if (abscissa > 0) values.abscissas.push_back(binary_number(bytes.substr(0, abscissa), header.is_big_endian));
    values.ordinates.push_back(binary_number(bytes.substr(abscissa), header.is_big_endian));
    if (!std::isfinite(values.ordinates.back()) || (abscissa > 0 && !std::isfinite(values.abscissas.back())))
      in.fail(fmt::format("value {} is not finite", i + 1));
  }
  if (whole_rows < header.count)
    left_out.push_back(fmt::format("the values after {} of {}: the file ends there", whole_rows, header.count));
  in.skip(header.bytes);
  if (whole_rows == header.count && !in.at_end()) {
    std::string_view rest = in.rest();
    rest.remove_prefix(std::min(rest.find_first_not_of("\r\n"), rest.size()));
    if (!rest.starts_with(end_mark)) in.fail("the end mark, -1, must follow the bytes of a data set 58b");
    while (!in.at_end() && !is_mark(in.line())) continue;
  }
  return values;
}

Values read_values(Reader& in, const Header& header, std::vector<std::string>& left_out) {
  if (header.is_binary) return binary_values(in, header, left_out);
  if (header.count > in.rest().size())
    in.fail(fmt::format("the file is too short for the {} values of the data set", header.count));
  std::vector<double> numbers = ascii_numbers(in, header.is_even ? header.count : 2 * header.count, left_out);
  if (header.is_even) return {.abscissas = {}, .ordinates = std::move(numbers)};
  Values values;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
    values.abscissas.push_back(numbers[i]);
    values.ordinates.push_back(numbers[i + 1]);
  }
  return values;
}

std::vector<double> times_of(const Header& header, const Values& values) {
  const Unit unit = unit_of(header.time_unit).value_or(Unit{.measure = Measure::time, .symbol = "s"});
  std::vector<double> times(values.ordinates.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    times[i] = unit.in_si(header.is_even ? header.first + static_cast<double>(i) * header.step : values.abscissas[i]);
  return times;
}

// Checks a data set with unevenly spaced abscissas (times). If its header states a first abscissa or an increment other than 0,
// they must agree with the abscissas.
void require_same_axis(const Header& header, const Values& values, const std::vector<double>& times, std::size_t line,
                       const Refusals& refusals, const ReadKeys& keys) {
  if (header.is_even || (header.first == 0 && header.step == 0)) return;
  constexpr int digits_of_abscissas = 6;
  const Unit unit = unit_of(header.time_unit).value_or(Unit{.measure = Measure::time, .symbol = "s"});
  Preamble said;
  using Of = TimeClaim::Of;
  said.claims.push_back({.of = Of::start, .key = "first abscissa", .value = unit.in_si(header.first), .has_unit = true});
  if (header.step > 0)
    said.claims.push_back({.of = Of::interval, .key = "increment", .value = unit.in_si(header.step), .has_unit = true});
  const std::vector<std::uint32_t> lines(times.size(), static_cast<std::uint32_t>(line));
  const Missing none;
  const TimeColumn column{.raw = values.abscissas,
                          .missing = none,
                          .name = "time",
                          .unit = unit,
                          .column = 1,
                          .digits = digits_of_abscissas,
                          .lines = lines};
  static_cast<void>(times_of_rows(&column, times.size(), said, keys, refusals));
}

void add_channel(Recording& made, const Header& header, Values values) {
  Channel channel;
  channel.heading = channel.name = header.label.empty() ? std::string(trimmed(header.lines[0])) : header.label;
  channel.unit = header.unit;
  if (const std::optional<Unit> unit = unit_of(header.unit)) {
    channel.unit = unit->symbol;
    channel.is_voltage = unit->measure == Measure::voltage;
    channel.per_si = unit->per_si;
  }
  channel.column = static_cast<int>(made.channels.size() + 1);
  if (std::any_of(made.channels.begin(), made.channels.end(), [&](const Channel& other) { return other.name == channel.name; }))
    channel.name += fmt::format(" {}", channel.column);
  channel.values = std::move(values.ordinates);
  made.channels.push_back(std::move(channel));
}

// Skips the rest of a data set that does not become a channel of the recording.
void pass(Reader& in) {
  while (!in.at_end() && !is_mark(in.line())) continue;
}

}  // namespace

bool is_uff(std::string_view content) {
  constexpr std::array known{"15", "55", "58", "151", "164", "2411", "2414"};
  Lines lines(content.substr(0, 512));
  while (lines.next() && trimmed(lines.line()).empty()) continue;
  if (lines.line().starts_with(end_mark) && is_mark(lines.line())) return true;
  if (!lines.next()) return false;
  const std::string_view kind = trimmed(lines.line());
  return kind.starts_with("58b ") || std::find(known.begin(), known.end(), kind) != known.end();
}

Recording read_uff(std::string_view content, const std::string& file, const ReadKeys& keys) {
  Recording made{.file = file, .format = "UFF 58", .has_times = true};
  Reader in(content, file);
  std::vector<std::string> others;
  while (!in.at_end()) {
    if (!is_mark(in.line())) continue;
    if (in.at_end()) break;
    const std::string_view kind = in.line();
    const std::vector<std::string_view> words = words_of(kind);
    if (words.empty()) in.fail("the number of a data set must follow the mark -1");
    if (words.front() != "58" && words.front() != "58b" && words.front() != "58B") {
      others.push_back(printable_line(shortened(words.front(), 10)));
      pass(in);
      continue;
    }
    const Header header = read_header(in, kind);
    refuse_other_functions(in, header);
    const auto first_line = static_cast<std::uint32_t>(in.line_number() + 1);
    Values values = read_values(in, header, made.left_out);
    if (values.ordinates.empty()) in.fail("a data set 58 must have at least one whole value");
    std::vector<double> times = times_of(header, values);
    require_same_axis(header, values, times, first_line, Refusals(file), keys);
    if (header.is_binary) made.format = "UFF 58b";
    if (!made.channels.empty() && times != made.times) {
      made.left_out.push_back(fmt::format("data set \"{}\", which has other times", printable_line(header.label)));
      continue;
    }
    made.times_have_unit = unit_of(header.time_unit).has_value();
    made.times = std::move(times);
    made.lines.assign(made.times.size(), first_line);
    if (header.is_even) made.interval = unit_of(header.time_unit).value_or(Unit{}).in_si(header.step);
    add_channel(made, header, std::move(values));
  }
  for (const std::string& other : others) made.left_out.push_back("data set " + other);
  require(!made.channels.empty(), [&] {
    return fmt::format("{}: must hold a record over time (data set 58), but holds {}; modes and meshes are not records", file,
                       others.empty() ? "nothing" : "data set " + others.front());
  });
  return made;
}

}  // namespace softland::internal
