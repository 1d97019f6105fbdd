#include "studies/search/quasi_static.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/constants.h"

namespace softland {
namespace {

// A function of time: 0 until `begin`, linear to `height` at `end`, then constant.
struct Ramp {
  double begin, end, height;
  [[nodiscard]] double at(double time) const {
    if (time <= begin) return 0;
    return time >= end ? height : height * (time - begin) / (end - begin);
  }
};

// Returns the weights of the impulses of an input shaper: binomial coefficients, scaled to the sum 1.
std::vector<double> shaper(std::size_t impulses) {
  std::vector<double> weights{1};
  for (std::size_t n = 1; n < impulses; ++n) {
    weights.push_back(0);
    for (std::size_t k = n; k > 0; --k) weights[k] = (weights[k] + weights[k - 1]) / 2;
    weights[0] /= 2;
  }
  return weights;
}

// A piecewise linear signal: a first value plus a sum of ramps.
class BrokenLine {
 public:
  explicit BrokenLine(double first) : first_(first) {}

  /// Adds a ramp to the signal from `begin` to `end`, filtered by an input shaper whose impulses are half a `period` apart.
  void add(double begin, double end, double height, std::size_t impulses, double period) {
    const std::vector<double> weights = shaper(impulses);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const double shift = static_cast<double>(k) * period / 2;
      ramps_.push_back({begin + shift, end + shift, weights[k] * height});
    }
  }
  /// Adds a smooth edge of duration `length`: a ramp in half this time, which an input shaper of three impulses spreads over
  /// the whole duration.
  void add_edge(double begin, double length, double height) { add(begin, begin + length / 2, height, 3, length / 2); }
  void add_line(double begin, double end, double height) { ramps_.push_back({begin, end, height}); }

  [[nodiscard]] double end() const {
    double last = 0;
    for (const Ramp& r : ramps_) last = std::max(last, r.end);
    return last;
  }
  [[nodiscard]] double at(double time) const {
    double sum = first_;
    for (const Ramp& r : ramps_) sum += r.at(time);
    return sum;
  }
  /// Returns the corners of the signal as (time, value), without corners that follow another one within `apart` in time.
  [[nodiscard]] std::vector<std::pair<double, double>> points(double apart) const {
    std::vector<double> times{0};
    for (const Ramp& r : ramps_) times.insert(times.end(), {r.begin, r.end});
    std::sort(times.begin(), times.end());
    std::vector<std::pair<double, double>> all;
    for (const double time : times) {
      if (all.empty() || time > all.back().first + apart) all.emplace_back(time, at(time));
    }
    all.back().second = at(times.back());
    return all;
  }

 private:
  double first_;
  std::vector<Ramp> ramps_;
};

// Returns a piecewise linear waveform from the voltage `before` [V] through `points` (time, voltage), clamped to the voltage
// limits of the source and slowed to its slew limit.
Waveform slewed(const std::vector<std::pair<double, double>>& points, double before, const DriverLimits& limits) {
  Table table{.time = {0}, .voltage = {before}};
  double time = 0;
  for (const auto& [at, given] : points) {
    const double voltage = std::clamp(given, limits.min_voltage, limits.max_voltage);
    const double rise = std::abs(voltage - table.voltage.back()) / limits.max_slew;
    const double duration = std::max(at - time, rise);
    time = at;
    if (!(duration > 0) && voltage == table.voltage.back()) continue;
    table.time.push_back(table.time.back() + duration);
    table.voltage.push_back(voltage);
  }
  return table;
}

// Returns pairs: the square of the holding electrode's level [V^2], and the voltage at which the carrying drive then brings the
// nominal design to its contact [V]. The levels are spaced evenly in their square, up to `most` [V].
std::vector<std::pair<double, double>> touching_by_level(const PreparedScene& prepared, const StableApproach& approach,
                                                         double most) {
  constexpr int levels = 6;
  std::vector<std::pair<double, double>> all;
  for (int k = 0; k <= levels; ++k) {
    const double low = most * std::sqrt(static_cast<double>(k) / levels);
    const double reaches = touching_voltage(prepared, approach, low);
    if (!std::isfinite(reaches)) break;
    all.emplace_back(low * low, reaches);
  }
  if (all.size() < 2) all = {{0, approach.reaches}, {1, approach.reaches}};
  return all;
}

// End voltages of the two ramps in starting points of a search, as distances from the voltage at which the nominal design makes
// contact, in standard deviations of this voltage over devices. The first ramp (rise) ends below this voltage, by slow_before
// if the input shaper has more than two impulses, else by fast_before. The second ramp (line) ends above it, by `beyond`.
constexpr double slow_before = 3.5, fast_before = 1.5, beyond = 2;
// Lower limit on the standard deviation, over devices, of the voltage at which contact is made, as a share of this voltage.
constexpr double least_deviation = 0.005;
constexpr double nearest_points = 1e-6;  // least distance in time of two corners of a waveform, in periods of the first mode
// Wait in starting points between the end of the second ramp (line) and the rise of the holding electrode's voltage, in periods
// of the first mode. It is step_after_line if this rise is a plain step, and holder_after_line if its waveform is searched.
constexpr double step_after_line = 1.2, holder_after_line = 0.8;
constexpr double settle = 0.5;  // duration of an edge to the hold level, in periods of the first mode
// Levels of the holding electrode before contact, as shares of its hold level: the least level at first contact in a starting
// point, and the upper bound in the search.
constexpr double least_contact_level = 0.16, most_low = 0.5;
// Levels of the holding electrode before contact in further starting points, as shares of its hold level.
constexpr std::array lower_levels{0.03, 0.12};
// Return of the carrying drive, which moves the switch to its contact, to its own hold level, in periods of the first mode. It
// has the duration `back` if the waveform of the holding electrode is searched. If that electrode gives a plain step, it has
// the duration back_of_step after the wait back_after.
constexpr double back = 1, back_of_step = 5.7, back_after = 2;

}  // namespace

QuasiStatic::QuasiStatic(const PreparedScene& prepared, Actuator actuator, StableApproach approach, std::size_t impulses,
                         double first_touch)
    : approach_(std::move(approach)), impulses_(impulses) {
  const Drive& carrier = prepared.drives.at(approach_.drive);
  is_electrode_ = approach_.drive != piezo_drive;
  neutral_ = prepared.model.neutral_voltage(prepared.drives.place(approach_.drive));
  hold_ = carrier.hold_level(), before_ = carrier.value_before(), limits_ = *carrier.limits;
  period_ = 2 * pi / prepared.model.basis().angular_frequencies()[0];
  if (!approach_.holder.empty()) {
    const Drive& holder = prepared.drives.at(approach_.holder);
    holding_ = actuator == Actuator::pzt ? Holding::by_step : Holding::shaped;
    holder_hold_ = holder.hold_level(), holder_before_ = holder.value_before();
    holder_limits_ =
        holder.limits.value_or(DriverLimits{.min_voltage = std::min(0.0, holder_hold_), .max_voltage = holder_hold_});
  }
  reaches_.emplace_back(0, approach_.reaches);
  if (holding_ == Holding::shaped) reaches_ = touching_by_level(prepared, approach_, most_low * holder_hold_);
  approach_.deviation = std::max(approach_.deviation, least_deviation * std::abs(approach_.reaches));
  // Default time until the contact force is steady, as a multiple of the time of first contact under the plain step.
  constexpr double usual = 20;
  for (const double times : {usual, usual / 2, 2 * usual}) starts_.push_back(closed_form(times * first_touch, approach_.low));
  bound(starts_.front(), false);
  clamp_starts();
}

void QuasiStatic::clamp_starts() {
  for (std::vector<double>& start : starts_) {
    for (std::size_t k = 0; k < start.size(); ++k) start[k] = std::clamp(start[k], variables_[k].lower, variables_[k].upper);
  }
}

std::vector<std::string> QuasiStatic::drives() const {
  std::vector<std::string> all{approach_.drive};
  if (!approach_.holder.empty()) all.push_back(approach_.holder);
  return all;
}

double QuasiStatic::reaches(double low) const {
  const double square = low * low;
  for (std::size_t k = 1; k < reaches_.size(); ++k) {
    const auto [from, first] = reaches_[k - 1];
    const auto [to, second] = reaches_[k];
    if (square <= to || k + 1 == reaches_.size()) return first + (second - first) * (square - from) / (to - from);
  }
  return reaches_.front().second;
}

double QuasiStatic::share(double deviations) const {
  const double reach = std::abs(approach_.reaches);
  return std::min(1 + deviations * approach_.deviation / reach, std::max(1.0, std::abs(approach_.limit) / reach));
}

// Returns the waveform parameters by closed formulas. Devices carry a steady contact force from `steady` on [s]; the holding
// electrode is at `low` before contact [V].
std::vector<double> QuasiStatic::closed_form(double steady, double low) const {
  const double rise = share(impulses_ > 2 ? -slow_before : -fast_before), end = share(beyond);
  // Begin of the second ramp (line), in periods of the first mode: the end of the first ramp (rise), or half a period earlier
  // if the line passes the input shaper, too.
  const double risen = static_cast<double>(impulses_ + 1) / 2 - (impulses_ > 2 ? 0.5 : 0);
  const double after = holding_ == Holding::by_step  ? step_after_line
                       : holding_ == Holding::shaped ? holder_after_line + settle
                                                     : 1.0;
  const double line = std::max(0.3, steady / period_ - risen - after) * period_;
  switch (holding_) {
    case Holding::by_step:
      return {rise, line, end, step_after_line * period_, back_after * period_, back_of_step * period_};
    case Holding::shaped: {
      const double at_contact = std::max(low, least_contact_level * holder_hold_);
      return {rise, line, end, low, at_contact, holder_after_line * period_};
    }
    case Holding::by_itself:
      break;
  }
  return {rise, line, end, settle * period_};
}

void QuasiStatic::bound(const std::vector<double>& start, bool is_paced) {
  const std::string carrier = approach_.drive + ".", holder = approach_.holder + ".";
  const auto between = [&](std::string name, double lower, double upper) {
    variables_.push_back({std::move(name), lower, upper});
  };
  const double line = start[1];
  // Search bounds of the end voltages of the first ramp (rise) and of the second ramp (line): distance from the voltage at
  // which contact is made, in standard deviations of this voltage over devices.
  constexpr double earliest = 9, latest = 6;
  between(carrier + "rise", std::max(0.3, share(-earliest)), share(1));
  is_paced ? between(carrier + "line_s", std::max(0.2 * period_, line - 2 * period_), line + 2 * period_)
           : between(carrier + "line_s", 0.2 * period_, 5 * line + 5 * period_);
  between(carrier + "end", 1, 1 + latest * approach_.deviation / std::abs(approach_.reaches));
  switch (holding_) {
    case Holding::by_step:
      between(holder + "wait_s", 0, 3 * period_);
      between(carrier + "stay_s", 0, 4 * period_);
      between(carrier + "return_s", 0.5 * period_, 8 * period_);
      return;
    case Holding::shaped:
      between(holder + "low_V", 0, most_low * holder_hold_);
      between(holder + "contact_V", 0, most_low * holder_hold_);
      between(holder + "wait_s", 0, 2 * period_);
      return;
    case Holding::by_itself:
      break;
  }
  between(carrier + "settle_s", 0.05 * period_, 2 * period_);
}

QuasiStatic QuasiStatic::paced(double steady) const {
  QuasiStatic own = *this;
  own.variables_.clear();
  own.starts_ = {closed_form(steady, approach_.low)};
  own.bound(own.starts_.front(), true);
  if (holding_ == Holding::shaped) {
    for (const double level : lower_levels) own.starts_.push_back(closed_form(steady, level * holder_hold_));
  }
  own.clamp_starts();
  return own;
}

// Returns the waveform of the drive that carries the switch to its contact. `points` are (time, volts) of a piezo, or (time,
// square of volts) of an electrode. A ramp that is linear in the square becomes five chords of the voltage.
Waveform QuasiStatic::carrying(Points points) const {
  if (!is_electrode_) return slewed(points, before_, limits_);
  constexpr int chords = 5;
  const auto volts = [this](double square) { return neutral_ + std::sqrt(std::max(square, 0.0)); };
  Points drawn{{points.front().first, volts(points.front().second)}};
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto [begin, from] = points[k - 1];
    const auto [end, to] = points[k];
    const int parts = from == to ? 1 : chords;
    for (int i = 1; i <= parts; ++i) {
      const double share = static_cast<double>(i) / parts;
      drawn.emplace_back(begin + share * (end - begin), volts(from + share * (to - from)));
    }
  }
  return slewed(drawn, before_, limits_);
}

DriveWaveforms QuasiStatic::waveforms(std::span<const double> x) const {
  const auto strength = [this](double voltage) {
    const double acting = voltage - neutral_;
    return is_electrode_ ? acting * std::abs(acting) : voltage;
  };
  const double apart = nearest_points * period_;
  const double touching = reaches(holding_ == Holding::shaped ? x[3] : holder_before_), line = x[1];
  const auto within = [&](double voltage) { return std::clamp(voltage, limits_.min_voltage, limits_.max_voltage); };
  const double rise_voltage = within(x[0] * touching), end_voltage = within(x[2] * touching);
  // Number of impulses of the input shaper that filters the second ramp, the line; 1: no filter.
  const std::size_t of_line = impulses_ > 2 ? impulses_ : 1;
  const double risen = static_cast<double>(impulses_ + 1) / 2 * period_;
  const double begin = impulses_ > 2 ? risen - period_ / 2 : risen, end = begin + line;
  BrokenLine carrier(strength(before_));
  carrier.add(0, period_, strength(rise_voltage) - strength(before_), impulses_, period_);
  carrier.add(begin, end, strength(end_voltage) - strength(rise_voltage), of_line, period_);
  DriveWaveforms all;
  switch (holding_) {
    case Holding::by_itself:
      carrier.add_edge(carrier.end(), x[3], strength(hold_) - strength(end_voltage));
      break;
    case Holding::by_step: {
      const double instant = end + x[3];
      const std::vector<std::pair<double, double>> step{{instant, holder_before_}, {instant, holder_hold_}};
      all.emplace(approach_.holder, slewed(step, holder_before_, holder_limits_));
      carrier.add_edge(instant + x[4], x[5], strength(hold_) - strength(end_voltage));
      break;
    }
    case Holding::shaped: {
      BrokenLine holder(holder_before_);
      holder.add(0, period_, x[3] - holder_before_, impulses_, period_);
      const double up = end + x[5];
      holder.add_line(begin, up, x[4] - x[3]);
      holder.add_edge(up, settle * period_, holder_hold_ - x[4]);
      carrier.add_edge(holder.end(), back * period_, strength(hold_) - strength(end_voltage));
      all.emplace(approach_.holder, slewed(holder.points(apart), holder_before_, holder_limits_));
      break;
    }
  }
  all.emplace(approach_.drive, carrying(carrier.points(apart)));
  return all;
}

}  // namespace softland
