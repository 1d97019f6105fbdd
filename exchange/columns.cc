#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "base/trimmed.h"
#include "exchange/block.h"
#include "exchange/cells.h"
#include "exchange/measure.h"
#include "exchange/parsers.h"
#include "exchange/time_axis.h"

namespace softland::internal {
namespace {

constexpr std::string_view own_format = "softland CSV";

// Returns true for the name of a column of contact states, 0 or 1, that softland writes: "closed" or "NAME_closed". Such a
// column shows that softland wrote the file, in which two rows of the same time mean a jump of the state.
bool is_contact_state(std::string_view name) { return name == "closed" || name.ends_with("_closed"); }

/// Makes a recording (times and channels) from columns of numbers and from the lines above the columns.
class RecordingMaker {
 public:
  RecordingMaker(Block block, const Refusals& refusals, const ReadKeys& keys)
      : block_(std::move(block)), preamble_(block_.preamble), refusals_(refusals), keys_(keys) {}
  Recording make();

 private:
  [[noreturn]] void fail(const std::string& rule) const { refusals_.fail(rule); }

  [[nodiscard]] std::optional<Unit> unit_of_column(std::size_t k) const;
  void drop_rows_without_numbers();
  [[nodiscard]] std::optional<std::size_t> time_place() const;
  [[nodiscard]] std::optional<std::size_t> named_place(const std::string& name, int number, std::string_view key) const;
  void set_times(std::optional<std::size_t> place);
  [[nodiscard]] bool is_second_time(std::size_t k, std::size_t time) const;
  void add_channel(std::size_t k, bool is_only);
  void scale_codes();
  void refuse_spectrum() const;
  void refuse_logic_states() const;

  Block block_;
  const Preamble& preamble_;
  const Refusals& refusals_;
  const ReadKeys& keys_;
  Recording made_;
};

// Returns the unit of a column from the row of units, or else from the column's heading.
std::optional<Unit> RecordingMaker::unit_of_column(std::size_t k) const {
  std::optional<Unit> unit = unit_of(block_.units[k]);
  return unit ? unit : heading_of(block_.names[k]).unit;
}

void RecordingMaker::drop_rows_without_numbers() {
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
  if (dropped > 0) made_.left_out.push_back(fmt::format("{} rows at the end without numbers", dropped));
}

std::optional<std::size_t> RecordingMaker::named_place(const std::string& name, int number, std::string_view key) const {
  if (name.empty() && number == 0) return std::nullopt;
  for (std::size_t k = 0; k < block_.columns.size(); ++k) {
    if (number != 0 ? block_.columns[k] == number : block_.names[k] == name || heading_of(block_.names[k]).name == name) return k;
  }
  fail(number != 0 ? fmt::format("{} = {}: must be the number of a column of numbers", key, number)
                   : fmt::format("{} = \"{}\": must be the name of a column of numbers", key, printable_line(name)));
}

std::optional<std::size_t> RecordingMaker::time_place() const {
  if (const auto named = named_place(keys_.time_column, keys_.time_column_number, "time_column")) return named;
  const std::size_t count = block_.columns.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::optional<Unit> unit = unit_of_column(k);
    if (unit && (unit->measure == Measure::time || unit->measure == Measure::samples)) return k;
  }
  const auto named_one_of = [&](const auto& names) -> std::optional<std::size_t> {
    for (std::size_t k = 0; k < count; ++k) {
      if (std::ranges::find(names, lower_case(heading_of(block_.names[k]).name)) != std::end(names)) return k;
    }
    return std::nullopt;
  };
  // Names that a column of times may have. A column of row numbers is used for the times only if no column has such a name.
  constexpr std::array<std::string_view, 11> times{"time",      "t",    "x",     "x-axis", "xpos",  "times",
                                                   "timestamp", "zeit", "temps", "tempo",  "tiempo"};
  constexpr std::array<std::string_view, 3> rows{"index", "sample", "n"};
  if (const auto time = named_one_of(times)) return time;
  if (const auto row = named_one_of(rows)) return row;
  if (block_.has_headings || count < 2) return std::nullopt;
  // If the file has no column names, the first column holds the times if it never decreases and is not constant.
  const std::vector<double>& first = block_.values.front();
  const bool rises = std::is_sorted(first.begin(), first.end()) && first.front() < first.back();
  return rises ? std::optional<std::size_t>(0) : std::nullopt;
}

// Returns true if column `k` is a copy of the column of times `time`: some instruments write the times once per channel. Throws
// InvalidInput if both have the same name but other values. Returns false if the user has selected the column of times.
bool RecordingMaker::is_second_time(std::size_t k, std::size_t time) const {
  const bool is_said = !keys_.time_column.empty() || keys_.time_column_number > 0;
  if (is_said || !block_.has_headings || block_.names[time].empty() || block_.names[k] != block_.names[time]) return false;
  if (block_.values[k] != block_.values[time])
    fail(fmt::format("columns {} and {} are both times, but differ; give time_column for that of the channel",
                     block_.columns[time], block_.columns[k]));
  return true;
}

void RecordingMaker::set_times(std::optional<std::size_t> place) {
  std::optional<TimeColumn> column;
  if (place)
    column.emplace(TimeColumn{.raw = block_.values[*place],
                              .missing = block_.missing[*place],
                              .name = heading_of(block_.names[*place]).name,
                              .unit = unit_of_column(*place),
                              .column = block_.columns[*place],
                              .digits = block_.digits[*place],
                              .lines = block_.lines});
  RowTimes rows = times_of_rows(column ? &*column : nullptr, block_.lines.size(), preamble_, keys_, refusals_);
  made_.times = std::move(rows.times);
  made_.interval = rows.interval;
  made_.has_times = rows.stand_in_file;
  made_.times_have_unit = rows.have_unit;
  made_.last_digit = rows.last_digit;
  made_.notes.insert(made_.notes.end(), rows.notes.begin(), rows.notes.end());
}

// Converts the integer codes of a converter, which some instruments write instead of volts, to volts.
void RecordingMaker::scale_codes() {
  constexpr double largest_code = 32767, codes_per_division = 25;
  std::size_t whole = 0, fractions = 0;
  for (const Channel& c : made_.channels) {
    for (const double v : c.values) ++(v == std::floor(v) ? whole : fractions);
  }
  const bool are_codes = made_.format == "GW Instek CSV" && !made_.has_times && whole > fractions;
  if (are_codes && fractions > 0) fail("the channel must hold either codes or fractions of volts, not both");
  if (are_codes && (made_.channels.size() > 1 || !preamble_.vertical_scale))
    fail("the volts per division of these codes are not known; save one channel per file");
  if (made_.channels.size() != 1) return;
  Channel& channel = made_.channels.front();
  // The voltage of a code is offset + factor * (code / full_scale), so that full scale is exactly offset + factor.
  double full_scale = 1, factor = 1, offset = 0;
  if (preamble_.high && preamble_.low && made_.format == "Keysight arb") {
    const bool is_short = preamble_.text.find("short") != std::string::npos;
    if (is_short) full_scale = largest_code;
    factor = (*preamble_.high - *preamble_.low) / 2;
    offset = (*preamble_.high + *preamble_.low) / 2;
    channel.name = channel.heading = "V";
    channel.unit = "V";
    channel.is_voltage = true;
  } else if (are_codes) {
    full_scale = codes_per_division, factor = *preamble_.vertical_scale;
    made_.notes.push_back(
        fmt::format("numbers are codes, {} per division of {} V", codes_per_division, *preamble_.vertical_scale));
  } else {
    return;
  }
  for (double& value : channel.values) value = offset + value / full_scale * factor;
}

void RecordingMaker::refuse_spectrum() const {
  if (preamble_.horizontal_unit && preamble_.horizontal_unit->measure == Measure::frequency)
    fail(fmt::format("the file holds a spectrum over {}; give a record over time", preamble_.horizontal_unit->symbol));
  for (std::size_t k = 0; k < block_.columns.size(); ++k) {
    const Heading heading = heading_of(block_.names[k]);
    const std::optional<Unit> unit = unit_of_column(k);
    const bool is_frequency = (unit && unit->measure == Measure::frequency) || lower_case(heading.name).starts_with("freq");
    if (is_frequency && k == 0)
      fail(fmt::format("the file holds a spectrum (column {} is a frequency); give a record over time", block_.columns[k]));
  }
}

// Returns true for a name that logic analysers give a channel: "d0", "dio 3", "channel 0".
bool is_logic_name(std::string_view name) {
  constexpr std::array words{"dio", "d", "bit", "logic", "bus", "channel", "probe"};
  for (const std::string_view word : words) {
    if (!name.starts_with(word)) continue;
    const std::string_view rest = trimmed(name.substr(word.size()));
    if (!rest.empty() && rest.find_first_not_of("0123456789") == std::string_view::npos) return true;
  }
  return false;
}

void RecordingMaker::refuse_logic_states() const {
  const bool is_logic =
      !made_.channels.empty() && std::all_of(made_.channels.begin(), made_.channels.end(), [&](const Channel& c) {
        const std::string name = lower_case(c.name);
        const bool is_named_so = is_logic_name(name) || made_.format == "sigrok CSV" ||
                                 preamble_.text.find("logic") != std::string::npos ||
                                 preamble_.text.find("digital") != std::string::npos;
        return is_named_so && c.unit.empty() &&
               std::all_of(c.values.begin(), c.values.end(), [](double v) { return v == 0 || v == 1; });
      });
  if (is_logic) fail("the file holds logic states, 0 or 1; give a record of volts over time");
}

void RecordingMaker::add_channel(std::size_t k, bool is_only) {
  Channel channel;
  channel.heading = block_.names[k];
  channel.name = heading_of(channel.heading).name;
  channel.column = block_.columns[k];
  if (is_only && !preamble_.source.empty() && (channel.name.empty() || !made_.has_times)) channel.name = preamble_.source;
  if (channel.name.empty()) channel.name = fmt::format("column {}", channel.column);
  std::optional<Unit> unit = unit_of_column(k);
  if (!unit) unit = preamble_.vertical_unit;
  channel.is_state = made_.format == own_format && is_contact_state(channel.name);
  if (!unit && made_.format == own_format && !channel.is_state) unit = unit_of("V");
  if (unit) {
    channel.unit = unit->symbol;
    channel.is_voltage = unit->measure == Measure::voltage;
    channel.per_si = unit->per_si;
  } else {
    channel.unit = printable_line(trimmed(block_.units[k]));
  }
  channel.values = std::move(block_.values[k]);
  channel.missing = block_.missing[k];
  made_.channels.push_back(std::move(channel));
}

Recording RecordingMaker::make() {
  drop_rows_without_numbers();
  if (block_.lines.empty()) fail("must have at least one row with numbers");
  made_.file = refusals_.file();
  made_.left_out.insert(made_.left_out.begin(), block_.left_out.begin(), block_.left_out.end());
  made_.notes = block_.notes;
  made_.lines = block_.lines;
  const bool is_own = std::find(block_.names.begin(), block_.names.end(), "time_s") != block_.names.end();
  made_.format = is_own ? own_format : format_of(preamble_.text);
  refuse_spectrum();
  const std::optional<std::size_t> place = time_place();
  set_times(place);
  const TimeClaim* const samples = preamble_.first(TimeClaim::Of::samples);
  if (samples != nullptr && samples->value > static_cast<double>(block_.lines.size()))
    made_.notes.push_back(fmt::format("the file states {} samples, but holds {}", samples->value, block_.lines.size()));
  for (std::size_t k = 0; k < block_.columns.size(); ++k) {
    if (k == place || (place && is_second_time(k, *place))) continue;
    add_channel(k, block_.columns.size() == (place ? 2U : 1U));
  }
  if (made_.channels.empty()) fail("there is a column of times, but no column of values");
  made_.is_breakpoints = std::ranges::any_of(made_.channels, &Channel::is_state);
  scale_codes();
  refuse_logic_states();
  return std::move(made_);
}

}  // namespace

Recording read_columns(std::string_view text, const std::string& file, const ReadKeys& keys) {
  const Refusals refusals(file);
  std::optional<Block> lying = read_lying_rows(text, refusals, keys);
  return RecordingMaker(lying ? std::move(*lying) : read_block(text, refusals, keys), refusals, keys).make();
}

}  // namespace softland::internal
