#include "config/file_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/trimmed.h"
#include "config/drives.h"
#include "config/read_keys.h"
#include "exchange/trace.h"
#include "waveforms/thinned.h"

namespace softland::internal {
namespace {

constexpr int digits = 4;

bool says_something(const SectionReader& in) {
  return std::any_of(file_keys::all.begin(), file_keys::all.end(), [&](std::string_view key) { return in.is_given(key); });
}

/// Returns true for a file that softland wrote: its first line that is not a comment has a column time_s.
bool is_own(std::string_view content) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (content.starts_with(byte_order_mark)) content.remove_prefix(byte_order_mark.size());
  std::string_view line;
  while (!content.empty() && (line.empty() || line.starts_with('#'))) {
    const std::size_t end = content.find('\n');
    line = trimmed(content.substr(0, end));
    content.remove_prefix(end == std::string_view::npos ? content.size() : end + 1);
  }
  for (;;) {
    const std::size_t comma = line.find(',');
    if (trimmed(line.substr(0, comma)) == "time_s") return true;
    if (comma == std::string_view::npos) return false;
    line.remove_prefix(comma + 1);
  }
}

/// Returns the smallest and the largest of the first `count` voltages.
std::pair<double, double> extremes(const std::vector<double>& values, std::size_t count) {
  const auto [least, most] = std::minmax_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
  return {*least, *most};
}

// Adds `shift` to the times of recorded rows. A time that is 0 but for rounding becomes 0 exactly.
void shift_times(std::vector<double>& times, double shift) {
  constexpr double rounding = 1e-6;  // rounding error of a time, as a share of the mean interval of the rows
  const double step = (times.back() - times.front()) / static_cast<double>(times.size());
  for (double& time : times) {
    time += shift;
    if (std::abs(time) < rounding * step) time = 0;
  }
}

// Returns the voltage before t = 0: the mean of the rows before t = 0, which must be constant up to noise.
double level_before(const SectionReader& in, const Trace& trace, std::size_t count) {
  constexpr double noise = 0.05;  // permitted variation of the voltage before t = 0, as a share of the range of the record
  const auto [least, most] = extremes(trace.values, count);
  const auto [smallest, largest] = extremes(trace.values, trace.values.size());
  if (most - least > noise * (largest - smallest)) {
    in.fail(fmt::format(
        "the {} rows before t = 0 range from {} to {}, but must be constant: shift = \"first\" starts at the first row, "
        "shift = \"...\" moves t = 0, before = \"...\" gives the voltage before t = 0",
        count, engineering(least, "V", digits), engineering(most, "V", digits)));
  }
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += trace.values[i];
  return least == most ? least : std::clamp(sum / static_cast<double>(count), least, most);
}

// Returns the recorded rows from t = 0 on. If no row is at t = 0, adds a first row there with the interpolated voltage, or
// with the first recorded voltage if the record begins after t = 0.
FileRows from_zero(const SectionReader& in, const Trace& trace) {
  FileRows rows;
  const auto at_zero = std::find_if(trace.times.begin(), trace.times.end(), [](double time) { return time >= 0; });
  const auto count = static_cast<std::size_t>(at_zero - trace.times.begin());
  if (count == trace.times.size())
    in.fail(fmt::format("all rows are before t = 0, the last at {}; shift = \"first\" or shift = \"...\" moves them",
                        engineering(trace.times.back(), "s", digits)));
  std::vector<double>& time = rows.table.time;
  std::vector<double>& voltage = rows.table.voltage;
  if (*at_zero > 0) {
    time.push_back(0);
    if (count == 0) {
      voltage.push_back(trace.values.front());
      rows.note += fmt::format("; its first value holds from t = 0 to {}", engineering(*at_zero, "s", digits));
    } else {
      const double share = -trace.times[count - 1] / (trace.times[count] - trace.times[count - 1]);
      voltage.push_back(std::lerp(trace.values[count - 1], trace.values[count], share));
    }
  }
  time.insert(time.end(), at_zero, trace.times.end());
  voltage.insert(voltage.end(), trace.values.begin() + static_cast<std::ptrdiff_t>(count), trace.values.end());
  if (count == 0) return rows;
  if (in.is_given(before_key)) {
    rows.note += fmt::format("; {} rows before t = 0 are skipped, because before is given", count);
  } else {
    rows.before = level_before(in, trace, count);
    rows.note += fmt::format("; before t = 0: {}, the mean of {} rows", engineering(*rows.before, "V", digits), count);
  }
  return rows;
}

// Removes rows of a long record that do not change the voltage after the low-pass filter of [driver]. Without the key
// bandwidth, the filter has a time constant of 1/2000 of the record.
void downsample(FileRows& rows, const SectionReader& driver) {
  constexpr std::size_t few = 4096;
  constexpr double relative_error = 1e-3, parts = 2000;
  Table& table = rows.table;
  const bool takes_samples = driver.is_present() && driver.is_given("sample_rate");
  if (table.time.size() <= few || takes_samples) return;
  const bool has_bandwidth = driver.is_present() && driver.is_given("bandwidth");
  const double time_constant =
      has_bandwidth ? 1 / (2 * std::numbers::pi * driver.number("bandwidth")) : table.time.back() / parts;
  const auto [least, most] = extremes(table.voltage, table.voltage.size());
  const std::size_t count = table.time.size();
  Thinned made = thinned(table, time_constant, relative_error * (most - least));
  if (2 * made.table.time.size() > count) return;  // keep the rows if thinning saves less than half
  table = std::move(made.table);
  rows.note += fmt::format("; thinned from {} to {} rows: after filtering with {} of {} they differ by less than {}", count,
                           table.time.size(), has_bandwidth ? "the bandwidth" : "a bandwidth",
                           engineering(1 / (2 * std::numbers::pi * time_constant), "Hz", 3), engineering(made.error, "V", 2));
}

FileRows read_foreign(const SectionReader& in, std::string_view content, const std::string& path, std::string_view drive,
                      const SectionReader& driver) {
  const ReadKeys keys = read_keys(in);
  Trace trace = trace_of(parse_recording(content, path, keys), keys, std::string(drive), drive == dispersion_drive);
  const double scale = in.is_given(file_keys::scale) ? in.number(file_keys::scale) : 1;
  for (double& value : trace.values) value *= scale;
  const bool from_first = in.is_given(file_keys::shift) && in.is_word(file_keys::shift);
  const double shift = from_first ? -trace.times.front() : in.is_given(file_keys::shift) ? in.number(file_keys::shift) : 0;
  shift_times(trace.times, shift);
  FileRows rows = from_zero(in, trace);
  downsample(rows, driver);
  rows.note = fmt::format("{}: {}{}", in.written(file_key), trace.note, rows.note);
  return rows;
}

}  // namespace

FileRows read_file_rows(const SectionReader& waveform, std::string_view drive, const SectionReader& driver) {
  const SectionReader& in = waveform;
  const std::string& name = in.text(file_key);
  in.require(!name.empty() && name.find('\0') == std::string::npos, file_key, "must be the name of a file");
  const std::string path = (in.file().directory / name).string();
  try {
    const std::string content = read_file(path);
    if (is_own(content) && !says_something(in)) return {.table = parse_table(content, path, std::string(drive))};
    return read_foreign(in, content, path, drive, driver);
  } catch (const InvalidInput& error) {
    const std::string_view what = error.what();
    if (what.find(in.path()) != std::string_view::npos) throw;  // the message already names a key of [waveform.NAME]
    in.file().fail(in.path(file_key), what);
  }
}

}  // namespace softland::internal
