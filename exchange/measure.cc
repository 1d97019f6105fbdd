#include "exchange/measure.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "base/trimmed.h"
#include "exchange/cells.h"

namespace softland::internal {
namespace {

struct UnitRow {
  std::string_view word;  ///< unit as written; in words of four letters or more, case is ignored
  Measure measure;
  std::string_view symbol;
  double per_si = 1;
};
constexpr std::array units{
    UnitRow{"s", Measure::time, "s"},
    UnitRow{"S", Measure::time, "s"},
    UnitRow{"sec", Measure::time, "s"},
    UnitRow{"second", Measure::time, "s"},
    UnitRow{"seconds", Measure::time, "s"},
    UnitRow{"ms", Measure::time, "ms", 1e3},
    UnitRow{"us", Measure::time, "us", 1e6},
    UnitRow{"uS", Measure::time, "us", 1e6},
    UnitRow{"\xC2\xB5s", Measure::time, "us", 1e6},
    UnitRow{"\xCE\xBCs", Measure::time, "us", 1e6},
    UnitRow{"\xB5s", Measure::time, "us", 1e6},
    UnitRow{"ns", Measure::time, "ns", 1e9},
    UnitRow{"ps", Measure::time, "ps", 1e12},
    UnitRow{"microseconds", Measure::time, "us", 1e6},
    UnitRow{"milliseconds", Measure::time, "ms", 1e3},
    UnitRow{"nanoseconds", Measure::time, "ns", 1e9},
    UnitRow{"V", Measure::voltage, "V"},
    UnitRow{"v", Measure::voltage, "V"},
    UnitRow{"volt", Measure::voltage, "V"},
    UnitRow{"volts", Measure::voltage, "V"},
    UnitRow{"voltage", Measure::voltage, "V"},
    UnitRow{"mV", Measure::voltage, "mV", 1e3},
    UnitRow{"mv", Measure::voltage, "mV", 1e3},
    UnitRow{"uV", Measure::voltage, "uV", 1e6},
    UnitRow{"\xC2\xB5V", Measure::voltage, "uV", 1e6},
    UnitRow{"\xCE\xBCV", Measure::voltage, "uV", 1e6},
    UnitRow{"kV", Measure::voltage, "kV", 1e-3},
    UnitRow{"millivolts", Measure::voltage, "mV", 1e3},
    UnitRow{"Hz", Measure::frequency, "Hz"},
    UnitRow{"hz", Measure::frequency, "Hz"},
    UnitRow{"hertz", Measure::frequency, "Hz"},
    UnitRow{"kHz", Measure::frequency, "kHz", 1e-3},
    UnitRow{"MHz", Measure::frequency, "MHz", 1e-6},
    UnitRow{"GHz", Measure::frequency, "GHz", 1e-9},
    UnitRow{"S/s", Measure::frequency, "S/s"},
    UnitRow{"Sa/s", Measure::frequency, "S/s"},
    UnitRow{"kS/s", Measure::frequency, "kS/s", 1e-3},
    UnitRow{"kSa/s", Measure::frequency, "kS/s", 1e-3},
    UnitRow{"MS/s", Measure::frequency, "MS/s", 1e-6},
    UnitRow{"MSa/s", Measure::frequency, "MS/s", 1e-6},
    UnitRow{"GS/s", Measure::frequency, "GS/s", 1e-9},
    UnitRow{"GSa/s", Measure::frequency, "GS/s", 1e-9},
    UnitRow{"sequence", Measure::samples, "samples"},
    UnitRow{"sample", Measure::samples, "samples"},
    UnitRow{"samples", Measure::samples, "samples"},
    UnitRow{"points", Measure::samples, "samples"},
    UnitRow{"dB", Measure::level, "dB"},
    UnitRow{"dBm", Measure::level, "dBm"},
    UnitRow{"dBV", Measure::level, "dBV"},
    UnitRow{"A", Measure::other, "A"},
    UnitRow{"mA", Measure::other, "mA"},
    UnitRow{"uA", Measure::other, "uA"},
    UnitRow{"amp", Measure::other, "A"},
    UnitRow{"amps", Measure::other, "A"},
    UnitRow{"ampere", Measure::other, "A"},
    UnitRow{"W", Measure::other, "W"},
    UnitRow{"watt", Measure::other, "W"},
    UnitRow{"ohm", Measure::other, "ohm"},
    UnitRow{"Pa", Measure::other, "Pa"},
    UnitRow{"m", Measure::other, "m"},
    UnitRow{"um", Measure::other, "um"},
    UnitRow{"nm", Measure::other, "nm"},
    UnitRow{"m/s", Measure::other, "m/s"},
    UnitRow{"mm/s", Measure::other, "mm/s"},
    UnitRow{"m/s2", Measure::other, "m/s2"},
    UnitRow{"m/s^2", Measure::other, "m/s2"},
    UnitRow{"g", Measure::other, "g"},
};

bool same_letters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  });
}

std::string_view without_brackets(std::string_view text) {
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}}) {
    if (text.size() >= 2 && text.front() == open && text.back() == close) return trimmed(text.substr(1, text.size() - 2));
  }
  return text;
}

// Returns the heading whose name is the text before index `at` and whose unit is `rest`; none if `rest` is not a known unit.
std::optional<Heading> split_heading(std::string_view text, std::size_t at, std::string_view rest) {
  std::optional<Unit> unit = unit_of(trimmed(rest));
  if (!unit) return std::nullopt;
  return Heading{.name = std::string(trimmed(text.substr(0, at))), .unit = std::move(unit)};
}

}  // namespace

std::optional<Unit> unit_of(std::string_view text) {
  text = without_brackets(trimmed(text));
  constexpr std::size_t shortest_word = 4;
  for (const UnitRow& row : units) {
    if (text == row.word || (row.word.size() >= shortest_word && same_letters(text, row.word)))
      return Unit{.measure = row.measure, .symbol = std::string(row.symbol), .per_si = row.per_si};
  }
  return std::nullopt;
}

Heading heading_of(std::string_view text) {
  text = trimmed(text);
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}}) {
    const std::size_t at = text.rfind(open);
    if (at == std::string_view::npos || text.back() != close) continue;
    if (auto heading = split_heading(text, at, text.substr(at + 1, text.size() - at - 2))) return *heading;
  }
  constexpr std::string_view in = " in ";
  if (const std::size_t at = text.rfind(in); at != std::string_view::npos) {
    if (auto heading = split_heading(text, at, text.substr(at + in.size()))) return *heading;
  }
  if (text.starts_with("in ")) {
    if (auto heading = split_heading(text, 0, text.substr(3))) return *heading;
  }
  if (const std::size_t at = text.rfind('/'); at != std::string_view::npos && at > 0) {
    if (auto heading = split_heading(text, at, text.substr(at + 1))) return *heading;
  }
  if (text.size() > 5 && same_letters(text.substr(0, 5), "time_")) {
    if (auto heading = split_heading(text, 4, text.substr(5))) return *heading;
  }
  // Split headings of columns such as "main_mV" and "resistance_ohm".
  if (const std::size_t at = text.rfind('_');
      at != std::string_view::npos && at > 0 && (text.ends_with('V') || text.ends_with("_ohm"))) {
    auto heading = split_heading(text, at, text.substr(at + 1));
    if (heading && (heading->unit->measure == Measure::voltage || heading->unit->symbol == "ohm")) return *heading;
  }
  Heading heading{.name = std::string(text), .unit = {}};
  // Split headings of columns such as "CH1V" into name and unit.
  if (text.size() > 3 && same_letters(text.substr(0, 2), "ch") && text.ends_with('V') &&
      text.find_first_not_of("0123456789", 2) == text.size() - 1)
    return {.name = std::string(text.substr(0, text.size() - 1)), .unit = unit_of("V")};
  // Circuit simulators write V(node) for a voltage and I(device) for a current.
  if (text.size() > 3 && text[1] == '(' && text.back() == ')' && (text[0] == 'V' || text[0] == 'v')) heading.unit = unit_of("V");
  if (text.size() > 3 && text[1] == '(' && text.back() == ')' && (text[0] == 'I' || text[0] == 'i')) heading.unit = unit_of("A");
  return heading;
}

std::optional<Measured> measured(std::string_view text) {
  text = trimmed(text);
  const std::size_t end = std::min(text.find_first_not_of("+-.,0123456789"), text.size());
  std::size_t stop = end;
  if (end + 1 < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    const std::size_t digits = text.find_first_not_of("+-0123456789", end + 1);
    if (digits != end + 1) stop = std::min(digits, text.size());
  }
  DecimalSign any;
  const std::string_view number = trimmed(text.substr(0, stop)), rest = trimmed(text.substr(stop));
  const Cell cell = read_cell(number, any);
  if (cell.kind != CellKind::number) return std::nullopt;
  Measured made{.value = cell.value, .number = number, .unit = unit_of(rest)};
  return rest.empty() || made.unit ? std::optional(std::move(made)) : std::nullopt;
}

std::optional<Measured> measured_value(std::string_view text, const std::optional<Unit>& unit) {
  text = trimmed(text);
  if (const std::size_t colon = text.rfind(':'); colon != std::string_view::npos) {
    const bool is_clock = text.substr(0, colon).find_first_not_of("0123456789:-/ .") == std::string_view::npos;
    if (is_clock && colon > 0) return std::nullopt;
    text = text.substr(colon + 1);
  }
  std::optional<Measured> number = measured(text);
  if (number && !number->unit) number->unit = unit;
  return number;
}

bool is_unit_of_cells(const std::optional<Unit>& unit) {
  if (!unit) return false;
  // In a cell such as "5m", m or g may also be a scale suffix of SPICE (milli, giga), so metres and grams are not accepted.
  const bool is_suffix = unit->symbol == "m" || unit->symbol == "g";
  return unit->measure == Measure::time || unit->measure == Measure::voltage || (unit->measure == Measure::other && !is_suffix);
}

std::optional<Measured> measured_cell(std::string_view cell) {
  std::optional<Measured> number = measured(cell);
  return number && is_unit_of_cells(number->unit) ? number : std::nullopt;
}

}  // namespace softland::internal
