#include "exchange/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/engineering.h"
#include "base/printable.h"
#include "base/require.h"
#include "exchange/measure.h"

namespace softland {
namespace {

using internal::Measure;
using internal::Unit;
using internal::unit_of;

constexpr int digits = 6;
// Relative rounding error of times that some instruments compute in single precision.
constexpr double single_precision = 1.2e-7;

std::string seconds(double time) { return engineering(time, "s", digits); }

double volts_divisor(const Recording& recording, const Channel& channel, const ReadKeys& keys, bool any_unit, std::string& note) {
  if (!keys.unit.empty()) {
    const std::optional<Unit> unit = unit_of(keys.unit);
    require(unit && (any_unit || unit->measure == Measure::voltage),
            [&] { return fmt::format("{}: unit = \"{}\" must be V, mV, uV or kV", recording.file, printable_line(keys.unit)); });
    return unit->per_si;
  }
  if (channel.unit.empty()) {
    if (!any_unit && !channel.is_state) note += "; the file names no unit: V is assumed";
    return 1;
  }
  require(channel.is_voltage || any_unit, [&] {
    return fmt::format("{}: \"{}\" is in {}, not in volts; unit = \"V\" reads its numbers as volts, and scale multiplies them",
                       recording.file, printable_line(channel.name), channel.unit);
  });
  return channel.per_si;
}

std::vector<double> even(double first, double interval, std::size_t count) {
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) times[i] = first + static_cast<double>(i) * interval;
  return times;
}

/// Returns the largest deviation of times from evenly spaced times with the same first time [s].
double deviation(const std::vector<double>& times, double interval) {
  double most = 0;
  for (std::size_t i = 0; i < times.size(); ++i)
    most = std::max(most, std::abs(times[i] - times.front() - static_cast<double>(i) * interval));
  return most;
}

/// Returns the largest rounding error that times may have as written in the file [s].
double rounding(const Recording& recording) {
  const std::vector<double>& t = recording.times;
  return 1.01 * recording.last_digit + single_precision * std::max(std::abs(t.front()), std::abs(t.back()));
}

// If at least nine of ten intervals between rows are equal, returns the first row after an interval that differs, for example
// after a gap in the record. Returns none if the intervals are uneven in general.
std::optional<std::size_t> odd_step(const Recording& recording) {
  constexpr double most_of = 0.9;
  const std::vector<double>& t = recording.times;
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
  if (steps.size() < 10) return std::nullopt;
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double tolerance = 2 * rounding(recording);
  std::size_t alike = 0, odd = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (std::abs(steps[i] - *middle) <= tolerance) {
      ++alike;
    } else if (odd == 0) {
      odd = i + 1;
    }
  }
  if (odd == 0 || static_cast<double>(alike) < most_of * static_cast<double>(steps.size())) return std::nullopt;
  return odd;
}

void require_not_back(const Recording& recording, const TimeAxis& axis) {
  if (!axis.back) return;
  const std::size_t row = *axis.back;
  throw InvalidInput(
      fmt::format("{}: the time decreases from {} to {}; interval = \"...\" sets even times, and skip leaves out lines, "
                  "such as a first segment",
                  recording.place(row), seconds(recording.times[row - 1]), seconds(recording.times[row])));
}

void require_no_repeats(const Recording& recording, const TimeAxis& axis) {
  if (axis.repeated == 0) return;
  const std::vector<double>& t = recording.times;
  std::size_t row = 1;
  while (t[row] != t[row - 1]) ++row;
  throw InvalidInput(
      fmt::format("{}: the time {} is given twice, and {} rows have the time of the row above; "
                  "interval = \"...\" sets even times, interval = \"uneven\" makes two rows of the same time a jump",
                  recording.place(row), seconds(t[row]), axis.repeated));
}

// Returns the times of the rows according to the user's keys and to the file.
std::vector<double> resolved_times(const Recording& recording, const ReadKeys& keys, std::string& note) {
  const std::size_t count = recording.rows();
  require(!recording.times.empty(), [&] {
    return fmt::format(
        "{}: the file has neither times nor an interval; give interval = \"...\", the time between rows, or time_column",
        recording.file);
  });
  if (keys.interval) return recording.times;  // read_recording() has set evenly spaced times already
  const TimeAxis axis = time_axis(recording);
  if (keys.uneven || recording.is_breakpoints) {
    require_not_back(recording, axis);
    return recording.times;
  }
  if (!recording.has_times) return recording.times;
  if (recording.interval) {
    constexpr double printed = 1e-5;  // relative rounding error of an interval that is written with few digits
    const double off = deviation(recording.times, *recording.interval), duration = std::abs(axis.last - axis.first);
    if (!(off <= rounding(recording) + printed * duration)) {
      throw InvalidInput(
          fmt::format("{}: the file states that rows are {} apart, but its times deviate by {}; "
                      "interval = \"{}\" uses that interval, interval = \"uneven\" the times",
                      recording.file, seconds(*recording.interval), seconds(off), seconds(*recording.interval)));
    }
    // Times that deviate from even spacing by at most this share of the interval are used as written. Larger deviations are
    // rounding errors, so even times replace the times.
    constexpr double exact = 1e-3;
    if (axis.repeated == 0 && !axis.back && off <= exact * *recording.interval) return recording.times;
    note += fmt::format("; times are rounded to {}: replaced by even times from the first one with the interval of the file",
                        seconds(recording.last_digit));
    return even(recording.times.front(), *recording.interval, count);
  }
  require_not_back(recording, axis);
  require_no_repeats(recording, axis);
  if (count > 2 && deviation(recording.times, axis.interval) > rounding(recording)) {
    if (const auto row = odd_step(recording)) {
      throw InvalidInput(
          fmt::format("{}: the time is {} after that of the row above, but most rows are {} apart; "
                      "interval = \"uneven\" uses the times as written, interval = \"...\" sets even times",
                      recording.place(*row), seconds(recording.times[*row] - recording.times[*row - 1]), seconds(axis.interval)));
    }
  }
  return recording.times;
}

// Removes the rows without a finite value of the channel at both ends of the trace, and blank rows between others. Throws
// InvalidInput for a value out of range between finite values.
void drop_missing(const Recording& recording, const Channel& channel, Trace& trace, std::string& note) {
  if (channel.missing.count == 0) return;
  std::size_t first = 0, last = trace.values.size();
  while (first < last && !std::isfinite(trace.values[first])) ++first;
  while (last > first && !std::isfinite(trace.values[last - 1])) --last;
  require(first < last,
          [&] { return fmt::format("{}: \"{}\" must have numbers", recording.file, printable_line(channel.name)); });
  Trace kept;
  std::size_t between = 0;
  for (std::size_t i = first; i < last; ++i) {
    if (std::isfinite(trace.values[i])) {
      kept.times.push_back(trace.times[i]);
      kept.values.push_back(trace.values[i]);
      continue;
    }
    ++between;
  }
  require(between == 0 || !channel.missing.is_overrange, [&] {
    return fmt::format("{}:{}: column {}: \"{}\" must be finite, since it stands between finite numbers", recording.file,
                       channel.missing.line, channel.column, printable_line(channel.name));
  });
  note +=
      fmt::format("; {} rows without a number are left out, the first in line {}", channel.missing.count, channel.missing.line);
  trace.times = std::move(kept.times);
  trace.values = std::move(kept.values);
}

}  // namespace

Trace trace_of(const Recording& recording, const ReadKeys& keys, const std::string& usual, bool any_unit) {
  const Channel& channel = channel_of(recording, keys, usual);
  std::string note;
  const double divisor = volts_divisor(recording, channel, keys, any_unit, note);
  if (recording.has_times && !recording.times_have_unit && keys.time_unit.empty())
    note += "; the file names no unit of time: s is assumed";
  Trace trace{.times = resolved_times(recording, keys, note), .values = channel.values, .note = {}};
  for (double& value : trace.values) value /= divisor;
  drop_missing(recording, channel, trace, note);
  for (const std::string& one : recording.notes) note += "; " + one;
  for (const std::string& what : recording.left_out) note += "; left out: " + what;
  const std::string times = recording.is_breakpoints
                                ? fmt::format("from {} to {}", seconds(trace.times.front()), seconds(trace.times.back()))
                                : times_prose(time_axis(trace.times));
  const std::size_t count = trace.times.size();
  trace.note = fmt::format("{}, \"{}\": {} {}, {}{}", recording.format, printable_line(channel.name), count,
                           count == 1 ? "sample" : "samples", times, note);
  return trace;
}

}  // namespace softland
