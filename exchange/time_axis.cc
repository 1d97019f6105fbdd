#include "exchange/time_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/engineering.h"
#include "base/printable.h"
#include "exchange/cells.h"

namespace softland::internal {
namespace {

using Of = TimeClaim::Of;

// Relative rounding error that an interval or a time in a file may have.
constexpr double printed_digits = 1e-5;
// Relative rounding error of times that some instruments compute in single precision.
constexpr double single_precision = 1.2e-7;

std::string seconds(double time) { return engineering(time, "s", 6); }
std::string quoted(const std::string& key) { return "\"" + printable_line(key) + "\""; }

/// A sampling interval that the file states [s]. If the file gives no unit with the number, the unit may be the second or the
/// file's horizontal unit, such as ms: `value` is the interval in the first case, `in_units` in the second.
struct Interval {
  std::string source;
  double value = 0;
  std::optional<double> in_units = {};
};

class RowTimer {
 public:
  RowTimer(const TimeColumn* column, std::size_t count, const Preamble& preamble, const ReadKeys& keys, const Refusals& refusals)
      : column_(column), count_(count), preamble_(preamble), keys_(keys), refusals_(refusals) {
    // The horizontal unit in a Siglent file is that of the oscilloscope's display, not that of the times.
    if (format_of(preamble.text) != "Siglent CSV") unit_above_ = preamble.horizontal_unit;
  }
  RowTimes make();

 private:
  [[noreturn]] void fail(const std::string& rule) const { refusals_.fail(rule); }
  [[nodiscard]] bool is_decided() const { return keys_.interval || keys_.uneven; }
  [[nodiscard]] bool is_generator() const;
  [[nodiscard]] bool is_sample_count() const;
  [[nodiscard]] std::optional<double> in_horizontal_unit(const TimeClaim& claim) const;
  [[nodiscard]] double due_samples() const;
  [[nodiscard]] double start_of(const TimeClaim& claim, double interval) const;
  [[nodiscard]] double duration() const { return made_.times.back() - made_.times.front(); }
  [[nodiscard]] double intervals() const { return static_cast<double>(count_ - 1); }
  void take_unit();
  void require_count(double last) const;
  void find_intervals();
  void require_same_intervals();
  void require_same_starts() const;
  void set_even(double first_sample);
  void set_even_from_numbers();
  void set_shares_of_period();
  void set_times();
  void require_interval();
  void require_start() const;
  void require_unit() const;

  const TimeColumn* column_;
  std::size_t count_;
  const Preamble& preamble_;
  const ReadKeys& keys_;
  const Refusals& refusals_;
  std::optional<Unit> unit_, unit_above_;  // unit of times in the column, and unit of the horizontal axis in the preamble
  std::vector<Interval> intervals_;
  RowTimes made_;
};

// Returns true for a file of a waveform generator, whose samples cover one period.
bool RowTimer::is_generator() const {
  return (column_ == nullptr || column_->name == "xpos") &&
         (column_ != nullptr || preamble_.text.find("rigol:dg") != std::string::npos || preamble_.first(Of::interval) == nullptr);
}

std::optional<double> RowTimer::in_horizontal_unit(const TimeClaim& claim) const {
  if (claim.has_unit || !unit_above_ || unit_above_->measure != Measure::time || unit_above_->per_si == 1) return std::nullopt;
  return unit_above_->in_si(claim.value);
}

double RowTimer::due_samples() const {
  const TimeClaim* const samples = preamble_.first(Of::samples);
  return std::max(samples == nullptr ? 0 : samples->value, static_cast<double>(count_));
}

void RowTimer::take_unit() {
  if (column_ == nullptr) return;
  unit_ = column_->unit;
  if (!keys_.time_unit.empty()) {
    unit_ = unit_of(keys_.time_unit);
    if (!unit_ || unit_->measure != Measure::time)
      fail(fmt::format("time_unit = \"{}\" must be s, ms, us, ns or ps", printable_line(keys_.time_unit)));
  }
}

// Throws InvalidInput if the file states fewer samples than it holds: `last` is the number of rows, or the number of the last
// sample, counted from 1.
void RowTimer::require_count(double last) const {
  if (is_decided()) return;
  for (const TimeClaim& claim : preamble_.claims) {
    if (claim.of == Of::samples && claim.value < last)
      fail(fmt::format("the file states {} samples, but holds {} ({}); give interval = \"...\" or \"uneven\" to use all rows",
                       claim.value, last, quoted(claim.key)));
  }
}

void RowTimer::find_intervals() {
  if (keys_.interval) {
    intervals_.push_back({.source = "interval", .value = *keys_.interval});
    return;
  }
  for (const TimeClaim& claim : preamble_.claims) {
    if (claim.of == Of::interval)
      intervals_.push_back({.source = quoted(claim.key), .value = claim.value, .in_units = in_horizontal_unit(claim)});
  }
  const TimeClaim* const samples = preamble_.first(Of::samples);
  if (!is_generator() || samples == nullptr || !(samples->value > 0)) return;
  for (const TimeClaim& claim : preamble_.claims) {
    if (claim.of == Of::period)
      intervals_.push_back({.source = quoted(claim.key) + " and " + quoted(samples->key), .value = claim.value / samples->value});
  }
}

// Requires all sampling intervals that the file states to be equal, unless the user has decided which times to use.
void RowTimer::require_same_intervals() {
  if (intervals_.empty()) return;
  const Interval& first = intervals_.front();
  made_.interval = first.value;
  if (is_decided()) return;
  if (first.in_units)
    fail(
        fmt::format("{} is {} without a unit, and \"{}\" is the horizontal unit of the file: it may be {} or {}; "
                    "give interval = \"...\", the time between rows",
                    first.source, first.value, unit_above_->symbol, seconds(*first.in_units), seconds(first.value)));
  for (const Interval& other : intervals_) {
    const double off = std::abs(other.value - first.value) * intervals();
    if (!(off <= std::max(std::min(first.value, other.value), printed_digits * first.value * intervals())))
      fail(
          fmt::format("rows are {} apart according to {}, but {} according to {}; "
                      "give interval = \"...\", the time between rows",
                      seconds(first.value), first.source, seconds(other.value), other.source));
  }
}

double RowTimer::start_of(const TimeClaim& claim, double interval) const {
  if (claim.of == Of::start) return claim.value;
  if (claim.of == Of::trigger_sample) return -claim.value * interval;
  return claim.value - std::floor(due_samples() / 2) * interval;
}

bool is_start(const TimeClaim& claim) {
  return claim.of == Of::start || claim.of == Of::trigger_sample || claim.of == Of::centre;
}

void RowTimer::require_same_starts() const {
  const TimeClaim* first = nullptr;
  for (const TimeClaim& claim : preamble_.claims) {
    if (!is_start(claim)) continue;
    if (first == nullptr) first = &claim;
    const double one = start_of(*first, *made_.interval), other = start_of(claim, *made_.interval);
    if (!(std::abs(one - other) <= *made_.interval + printed_digits * std::abs(one)))
      fail(
          fmt::format("the first sample is at {} according to {}, but at {} according to {}; "
                      "interval = \"{}\" uses the first time, and skip leaves out lines at the beginning",
                      seconds(one), quoted(first->key), seconds(other), quoted(claim.key), seconds(*made_.interval)));
  }
}

// Sets the times of the rows from the sampling interval; `first_sample` is the number of the sample in the first row.
void RowTimer::set_even(double first_sample) {
  require_same_intervals();
  if (!made_.interval) return;
  if (!is_decided()) require_same_starts();
  // Time of the first sample. A file may state this time, the number of the sample at t = 0, or the time of the middle sample.
  double start = 0;
  for (const Of of : {Of::start, Of::trigger_sample, Of::centre}) {
    if (const TimeClaim* const claim = preamble_.first(of)) {
      start = start_of(*claim, *made_.interval);
      break;
    }
  }
  // If the first sample is a whole number of intervals from t = 0 but for rounding, set the time of one sample to exactly 0.
  constexpr double whole = 1e-6;
  const double steps = start / *made_.interval, rounded = std::round(steps);
  made_.times.resize(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    const double k = first_sample + static_cast<double>(i);
    made_.times[i] = std::abs(steps - rounded) < whole ? (rounded + k) * *made_.interval : start + k * *made_.interval;
  }
}

// Returns true if the column of times holds numbers of samples: its unit says so, or it holds whole numbers, is not called
// time, and the file states the sampling interval.
bool RowTimer::is_sample_count() const {
  if (unit_) return unit_->measure == Measure::samples;
  const std::vector<double>& raw = column_->raw;
  return !lower_case(column_->name).starts_with('t') && !intervals_.empty() &&
         std::all_of(raw.begin(), raw.end(), [](double value) { return value == std::floor(value); });
}

void RowTimer::set_even_from_numbers() {
  const std::vector<double>& raw = column_->raw;
  for (std::size_t i = 1; i < count_; ++i) {
    if (raw[i] != raw[i - 1] + 1)
      refusals_.fail(
          column_->lines[i], static_cast<std::size_t>(column_->column),
          fmt::format("the number of the sample is {}, and that above is {}; numbers must be consecutive", raw[i], raw[i - 1]));
  }
  // Samples are numbered from 0 in a column whose unit is samples, and from 1 in EasyWave files (column xpos). In other files,
  // they are numbered from 1 if the column begins with 1, otherwise from 0.
  const bool counts_from_one = !unit_ && (raw.front() == 1 || (column_->name == "xpos" && raw.front() > 1));
  const double first = raw.front() - (counts_from_one ? 1 : 0);
  require_count(first + static_cast<double>(count_));
  set_even(first);
  if (first != 0 && made_.interval)
    made_.notes.push_back(
        fmt::format("its first row is number {}: {} after the first sample", raw.front(), seconds(first * *made_.interval)));
}

// Sets the times from the column "xpos" of an EasyWave file, whose numbers are either shares of the period or times.
void RowTimer::set_shares_of_period() {
  const std::vector<double>& raw = column_->raw;
  if (intervals_.empty())
    fail(
        "\"xpos\" may be a share of the period or the number of a sample, "
        "but the file lacks \"data length\" and \"frequency\"; "
        "give interval = \"...\", the time between rows, or time_unit if \"xpos\" holds times");
  require_same_intervals();
  const double samples = due_samples(), interval = *made_.interval;
  const double step = count_ > 1 ? (raw.back() - raw.front()) / intervals() : 0;
  for (const double of_interval : {1 / samples, interval}) {
    if (!(std::abs(step - of_interval) * intervals() <= of_interval)) continue;
    made_.stand_in_file = true;
    made_.have_unit = true;
    for (const double x : raw) made_.times.push_back(x / of_interval * interval);
    made_.last_digit = std::pow(10, -column_->digits) * std::abs(made_.times.back());
    return;
  }
  if (is_decided()) return set_even(0);
  fail(
      fmt::format("\"xpos\" increases by {} per row; it must increase by 1 (sample numbers), "
                  "or by the share of a period of {} samples ({}), or by the time between rows ({}, from {}); "
                  "give interval = \"...\", the time between rows",
                  step, samples, 1 / samples, seconds(interval), intervals_.front().source));
}

void RowTimer::require_interval() {
  for (const Interval& claimed : intervals_) {
    std::optional<double> agreed;
    for (const std::optional<double>& value : {std::optional(claimed.value), claimed.in_units}) {
      const double tolerance =
          1.01 * made_.last_digit + single_precision * std::abs(made_.times.front()) + printed_digits * std::abs(duration());
      if (value && !agreed && std::abs(*value * intervals() - duration()) <= std::max(*value, tolerance)) agreed = value;
    }
    if (!agreed && !is_decided())
      fail(fmt::format(
          "the file states that rows are {} apart ({}), but its times deviate by {}; "
          "interval = \"{}\" uses that interval, interval = \"uneven\" the times; time_unit gives the unit of the times",
          seconds(claimed.value), claimed.source, seconds(std::abs(claimed.value * intervals() - duration())),
          seconds(claimed.value)));
    if (!made_.interval) made_.interval = agreed.value_or(claimed.value);
  }
}

void RowTimer::require_start() const {
  if (is_decided() || count_ < 2) return;
  const double interval = made_.interval.value_or(std::abs(duration()) / intervals());
  for (const TimeClaim& claim : preamble_.claims) {
    // Compare the first time with the statements of the preamble about it. Only GW Instek files state the time of the middle
    // sample reliably. A start without a unit may be of another quantity than time, unless the file states an interval.
    const bool is_axis = claim.of == Of::centre ? preamble_.text.find("sampling period") != std::string::npos
                                                : claim.has_unit || !intervals_.empty();
    if (!is_start(claim) || !is_axis) continue;
    const double due = start_of(claim, interval), found = made_.times.front();
    const double tolerance = interval + 1.01 * made_.last_digit + printed_digits * std::abs(due);
    const std::optional<double> other = in_horizontal_unit(claim);
    const bool agrees =
        std::abs(due - found) <= tolerance || (other && claim.of == Of::start && std::abs(*other - found) <= tolerance);
    if (!agrees)
      fail(
          fmt::format("the first row is at {} according to {}, but its time is {}; "
                      "interval = \"uneven\" uses the times, and skip leaves out lines at the beginning",
                      seconds(due), quoted(claim.key), seconds(found)));
  }
}

// Throws InvalidInput if the column and the preamble name different units of the times. If the file states the interval,
// require_interval() finds the right unit instead.
void RowTimer::require_unit() const {
  if (is_decided() || !keys_.time_unit.empty() || !unit_above_ || !column_->unit || unit_above_->measure != Measure::time) return;
  if (unit_above_->per_si == column_->unit->per_si || !intervals_.empty()) return;
  fail(fmt::format("the times are in {} according to their column, but in {} according to the preamble; give time_unit",
                   column_->unit->symbol, unit_above_->symbol));
}

void RowTimer::set_times() {
  if (!unit_) unit_ = unit_above_;
  made_.have_unit = unit_.has_value();
  if (!unit_) unit_ = Unit{.measure = Measure::time, .symbol = "s"};
  if (unit_->measure != Measure::time)
    fail(fmt::format(
        "column {} is in {}, which is not a unit of time; give time_column for another column, or time_unit for its unit",
        column_->column, unit_->symbol));
  require_unit();
  made_.stand_in_file = true;
  for (const double value : column_->raw) made_.times.push_back(unit_->in_si(value));
  const double largest = std::max(std::abs(made_.times.front()), std::abs(made_.times.back()));
  if (largest > 0) made_.last_digit = std::pow(10, std::floor(std::log10(largest)) - column_->digits + 1);
  require_interval();
  require_start();
}

RowTimes RowTimer::make() {
  take_unit();
  find_intervals();
  if (column_ == nullptr) {
    require_count(static_cast<double>(count_));
    set_even(0);
    return std::move(made_);
  }
  if (column_->missing.count > 0)
    refusals_.fail(column_->missing.line, static_cast<std::size_t>(column_->column),
                   "the time is missing; it must be a finite number");
  require_count(static_cast<double>(count_));
  if (is_sample_count()) {
    set_even_from_numbers();
  } else if (!unit_ && column_->name == "xpos") {
    set_shares_of_period();
  } else {
    set_times();
  }
  return std::move(made_);
}

}  // namespace

RowTimes times_of_rows(const TimeColumn* column, std::size_t count, const Preamble& preamble, const ReadKeys& keys,
                       const Refusals& refusals) {
  return RowTimer(column, count, preamble, keys, refusals).make();
}

}  // namespace softland::internal
