#include "waveforms/signal.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "base/require.h"
#include "waveforms/bounds.h"

namespace softland {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Returns the voltage [V] at the end of a straight signal piece. If possible this is a value from which the slope of the piece
/// is computed without any rounding error, since value + slope * duration has one; `favourite` is tried first. The exact value
/// matters at a jump after a ramp, for tables and their export.
double end_of_straight(const SignalPiece& piece, double end, double favourite) {
  const double duration = end - piece.begin;
  if (piece.slope == 0) return piece.value;
  const auto has_the_slope = [&](double value) { return (value - piece.value) / duration == piece.slope; };
  if (has_the_slope(favourite)) return favourite;
  const double rise = piece.slope * duration;
  const double computed = piece.value + rise;
  // Largest number of units of the last digit by which the rise, or the computed end value, is changed in the search for an
  // exact end value. In 2e7 random ramps the distance was at most one unit.
  constexpr int reach = 2;
  double rise_up = rise, rise_down = rise, value_up = computed, value_down = computed;
  for (int i = 0; i <= reach; ++i) {
    for (const double value : {piece.value + rise_up, piece.value + rise_down, value_up, value_down}) {
      if (has_the_slope(value)) return value;
    }
    rise_up = std::nextafter(rise_up, HUGE_VAL);
    rise_down = std::nextafter(rise_down, -HUGE_VAL);
    value_up = std::nextafter(value_up, HUGE_VAL);
    value_down = std::nextafter(value_down, -HUGE_VAL);
  }
  return computed;
}

/// Returns a bound on the rounding error of the computed voltage at the end of a signal piece [V].
double rounding_at_end(const SignalPiece& piece, double end) {
  constexpr double roundings = 16;
  const double duration = end - piece.begin;
  const double straight = std::abs(piece.value) + std::abs(piece.slope * duration);
  const double swing = std::abs(piece.amplitude) + std::abs(piece.amplitude_slope * duration);
  double of_terms = 0;  // size of the terms, as if they did not decay [V]: dropping a decayed term is no jump
  double rate = std::abs(piece.slope);
  for (const SignalTerm& term : piece.terms) {
    double power = 1, before = 0, size = 0;
    for (std::size_t k = 0; k < term.cosine.size(); ++k, before = power, power *= duration) {
      const double coefficient = std::abs(term.cosine[k]) + std::abs(term.sine[k]);
      size += coefficient * power;
      rate += static_cast<double>(k) * coefficient * before;
    }
    of_terms += size * (1 + std::abs(term.angular_frequency) * duration + std::abs(term.sweep) * duration * duration);
  }
  // Add the voltage error due to the rounding of the times at both ends of the piece, which grows with time.
  return roundings * epsilon *
         (rate * end + straight + swing * (1 + piece.angular_frequency * end + std::abs(piece.phase)) + of_terms);
}

/// Appends the time in (low, high) at which `function` changes its sign, found by bisection; appends nothing if the signs at
/// both ends are not opposite.
template <typename Function>
void append_root(std::vector<double>& times, Function function, double low, double high) {
  const double at_low = function(low);
  const double at_high = function(high);
  if (!((at_low < 0 && at_high > 0) || (at_low > 0 && at_high < 0))) return;
  // Number of bisections of a quarter period of the sine. The function is flat at an extremum, so fewer would be enough for its
  // value.
  constexpr int halvings = 40;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    ((function(middle) > 0) == (at_high > 0) ? high : low) = middle;
  }
  times.push_back(0.5 * (low + high));
}

/// Appends low, high and all times between at which the voltage or the dV/dt of a signal piece with a sine has an extremum.
///
/// V'' is proportional to 2 A' cos - A w sin, with A = amplitude + amplitude_slope (t - begin) and w = angular_frequency.
/// Within a quarter period of the sine in which A keeps its sign, V'' has one sign or is monotone, so it has at most one root.
/// Between these roots V' is monotone and has at most one root.
void append_extrema(std::vector<double>& times, const SignalPiece& piece, double low, double high) {
  const double quarter = 0.5 * std::numbers::pi;
  std::vector<double> grid{low, high};
  const double first = std::ceil((piece.angular_frequency * low + piece.phase) / quarter);
  const double last = std::floor((piece.angular_frequency * high + piece.phase) / quarter);
  // Largest number of quarter periods between low and high, which are at most a period apart. More occur only if the angle is
  // so large (2^53) that the sine has no correct digit.
  constexpr int most_quarters = 6;
  for (int k = 0; k <= most_quarters && first + k <= last; ++k) {
    grid.push_back(((first + k) * quarter - piece.phase) / piece.angular_frequency);
  }
  if (piece.amplitude_slope != 0) grid.push_back(piece.begin - piece.amplitude / piece.amplitude_slope);
  std::erase_if(grid, [&](double time) { return !(time >= low && time <= high); });
  std::sort(grid.begin(), grid.end());

  const auto curvature = [&](double time) {
    const double angle = piece.angular_frequency * time + piece.phase;
    const double envelope = piece.amplitude + piece.amplitude_slope * (time - piece.begin);
    return 2 * piece.amplitude_slope * std::cos(angle) - envelope * piece.angular_frequency * std::sin(angle);
  };
  std::vector<double> inflections = grid;
  for (std::size_t i = 0; i + 1 < grid.size(); ++i) append_root(inflections, curvature, grid[i], grid[i + 1]);
  std::sort(inflections.begin(), inflections.end());
  const auto rate = [&](double time) { return piece.rate(time); };
  for (std::size_t i = 0; i + 1 < inflections.size(); ++i) append_root(times, rate, inflections[i], inflections[i + 1]);
  times.insert(times.end(), inflections.begin(), inflections.end());
}

enum class Of { voltage, rate };

/// Returns times in [piece.begin, end] of a signal piece; the largest and the smallest voltage (or dV/dt) occur at some of
/// them.
///
/// Only the first and the last period of a sine are searched. V and V' at the same phase of successive periods are linear in
/// the number of the period, since the amplitude is linear in time, so they are largest in the first or the last period.
std::vector<double> extreme_times(const SignalPiece& piece, double end, Of what) {
  std::vector<double> times{piece.begin};
  if (std::isfinite(end)) times.push_back(end);
  if (!piece.terms.empty()) {
    // Search a last piece until its terms have decayed, and then for a period of its undamped sine.
    const double over = internal::duration_of_terms(piece);
    const double last =
        std::isfinite(end) ? end : piece.begin + over + (piece.oscillates() ? 2 * std::numbers::pi / piece.angular_frequency : 0);
    internal::append_extrema_of_terms(times, piece, what == Of::rate, piece.begin, last);
    return times;
  }
  if (!piece.oscillates()) return times;
  const double period = 2 * std::numbers::pi / piece.angular_frequency;
  append_extrema(times, piece, piece.begin, std::min(end, piece.begin + period));
  if (std::isfinite(end)) append_extrema(times, piece, std::max(piece.begin, end - period), end);
  return times;
}

/// Calls `see(piece, time)` at times on [0, end] that include those of the extreme voltage, or dV/dt, of every signal piece.
template <typename See>
void for_each_extreme(const std::vector<SignalPiece>& pieces, double end, Of what, See see) {
  require(end >= 0, fmt::format("the end of the time span is {} s; it must be >= 0", end));
  for (std::size_t i = 0; i < pieces.size() && pieces[i].begin <= end; ++i) {
    const double next = i + 1 < pieces.size() ? pieces[i + 1].begin : std::numeric_limits<double>::infinity();
    for (const double time : extreme_times(pieces[i], std::min(next, end), what)) see(pieces[i], time);
  }
}

/// Throws InvalidInput unless all numbers in the term of a signal piece are finite and its decay rate is not negative.
void check_term(const SignalTerm& term, std::size_t piece) {
  bool is_finite = std::isfinite(term.decay) && std::isfinite(term.angular_frequency) && std::isfinite(term.sweep);
  for (const double coefficient : term.cosine) is_finite = is_finite && std::isfinite(coefficient);
  for (const double coefficient : term.sine) is_finite = is_finite && std::isfinite(coefficient);
  if (!is_finite) throw InvalidInput(fmt::format("a term of piece {} of a signal is not finite", piece));
  if (!(term.decay >= 0))
    throw InvalidInput(fmt::format("the decay of a term of piece {} of a signal is {} 1/s; it must be >= 0", piece, term.decay));
}

}  // namespace

Signal::Signal(std::vector<SignalPiece> pieces, double before) : pieces_(std::move(pieces)), before_(before) {
  require(std::isfinite(before), fmt::format("the voltage of a signal before t = 0 is {} V; it must be finite", before));
  require(!pieces_.empty(), "a signal must have at least one piece");
  require(pieces_.front().begin == 0,
          fmt::format("the first piece of a signal begins at {} s; it must begin at 0 s", pieces_.front().begin));
  // Compose a message only when it is needed: measured tables have very many pieces.
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const SignalPiece& piece = pieces_[i];
    for (const auto& [name, number] :
         {std::pair{"begin", piece.begin}, std::pair{"value", piece.value}, std::pair{"slope", piece.slope},
          std::pair{"amplitude", piece.amplitude}, std::pair{"amplitude_slope", piece.amplitude_slope},
          std::pair{"angular_frequency", piece.angular_frequency}, std::pair{"phase", piece.phase}}) {
      if (!std::isfinite(number)) {
        throw InvalidInput(fmt::format("{} of piece {} of a signal is {}; it must be finite", name, i + 1, number));
      }
    }
    for (const SignalTerm& term : piece.terms) check_term(term, i + 1);
    if (!(i == 0 || piece.begin > pieces_[i - 1].begin)) {
      throw InvalidInput(
          fmt::format("piece {} of a signal begins at {} s; it must begin after the piece before it", i + 1, piece.begin));
    }
    if (piece.oscillates() && !(piece.angular_frequency > 0)) {
      throw InvalidInput(
          fmt::format("angular_frequency of piece {} of a signal is {} rad/s; it must be > 0", i + 1, piece.angular_frequency));
    }
  }
  const SignalPiece& last = pieces_.back();
  require(
      last.slope == 0,
      fmt::format("slope of the last piece of a signal is {} V/s; the last piece has no end and must be constant", last.slope));
  require(last.amplitude_slope == 0,
          fmt::format("amplitude_slope of the last piece of a signal is {} V/s; it must be 0, because the last piece has no end",
                      last.amplitude_slope));
  for (const SignalTerm& term : last.terms) {
    require(term.decay > 0 && term.sweep == 0,
            fmt::format("a term of the last piece of a signal has the decay {} 1/s and the sweep {} rad/s^2; "
                        "it must decay without sweep, because the last piece has no end",
                        term.decay, term.sweep));
  }
}

Signal Signal::constant(double voltage, double before) { return Signal({SignalPiece{.value = voltage}}, before); }

Signal Signal::standing(double voltage) { return constant(voltage, voltage); }

Signal Signal::piecewise_linear(const std::vector<std::pair<double, double>>& points, double before) {
  require(!points.empty(), "a piecewise linear signal must have at least one point");
  std::size_t count = points.size();
  while (count > 1 && points[count - 2].second == points[count - 1].second) --count;
  for (std::size_t i = 1; i < count; ++i) {
    const double time = points[i - 1].first, next_time = points[i].first;
    if (!(next_time >= time)) {
      throw InvalidInput(
          fmt::format("the time of point {} is {} s; it must be at least the {} s of the point before", i + 1, next_time, time));
    }
  }
  return Signal(internal::straight_pieces<double>({points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count)}), before);
}

std::size_t Signal::piece_at(double time) const {
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), time,
                                      [](double t, const SignalPiece& piece) { return t < piece.begin; });
  return static_cast<std::size_t>(after - pieces_.begin()) - 1;
}

double Signal::voltage(double time) const { return time < 0 ? before_ : pieces_[piece_at(time)].voltage(time); }

double Signal::left_limit(std::size_t next) const {
  const SignalPiece piece = next > 0 ? pieces_[next - 1] : SignalPiece{.value = before_};
  const double end = pieces_[next].begin;
  const double continuous = pieces_[next].voltage(end);
  const double computed = piece.is_straight() ? end_of_straight(piece, end, continuous) : piece.voltage(end);
  if (!piece.is_straight() || !pieces_[next].is_straight()) {
    const double rounding = rounding_at_end(piece, end) + rounding_at_end(pieces_[next], end);
    if (std::abs(computed - continuous) <= rounding) return continuous;
  }
  return computed;
}

double Signal::voltage_before(double time) const {
  if (time < 0) return before_;
  const std::size_t piece = piece_at(time);
  return pieces_[piece].begin == time ? left_limit(piece) : pieces_[piece].voltage(time);
}

std::vector<double> Signal::breakpoints() const {
  std::vector<double> begins;
  begins.reserve(pieces_.size());
  for (const SignalPiece& piece : pieces_) begins.push_back(piece.begin);
  return begins;
}

double Signal::hold_level() const { return pieces_.back().value; }

std::vector<double> hold_levels(std::span<const Signal> signals) {
  std::vector<double> levels;
  for (const Signal& signal : signals) levels.push_back(signal.hold_level());
  return levels;
}

std::vector<double> values_before(std::span<const Signal> signals) {
  std::vector<double> values;
  for (const Signal& signal : signals) values.push_back(signal.before());
  return values;
}

bool Signal::is_zero() const {
  return before_ == 0 && std::all_of(pieces_.begin(), pieces_.end(),
                                     [](const SignalPiece& piece) { return piece.value == 0 && piece.is_level(); });
}

Signal::Range Signal::range(double end) const {
  Range range{.minimum = before_, .maximum = before_};
  for_each_extreme(pieces_, end, Of::voltage, [&](const SignalPiece& piece, double time) {
    const double voltage = piece.voltage(time);
    range.minimum = std::min(range.minimum, voltage);
    range.maximum = std::max(range.maximum, voltage);
  });
  return range;
}

double Signal::peak(double end) const {
  const Range all = range(end);
  return std::max(all.maximum, -all.minimum);
}

double Signal::peak_slew(double end) const {
  double largest = 0;
  for_each_extreme(pieces_, end, Of::rate,
                   [&](const SignalPiece& piece, double time) { largest = std::max(largest, std::abs(piece.rate(time))); });
  for (const SignalPiece& piece : pieces_) {
    if (piece.begin <= end && voltage_before(piece.begin) != piece.voltage(piece.begin))
      return std::numeric_limits<double>::infinity();
  }
  return largest;
}

double Signal::resolving_step(double time) const {
  // Integrator steps per period of an oscillating voltage. They suffice for an integrator of order 2 or higher to notice the
  // oscillation; its error control then chooses the step length.
  constexpr double steps_per_period = 20;
  const std::size_t at = piece_at(time);
  const SignalPiece& piece = pieces_[at];
  double step = std::numeric_limits<double>::infinity();
  if (piece.oscillates()) step = 2 * std::numbers::pi / piece.angular_frequency / steps_per_period;
  for (const SignalTerm& term : piece.terms) {
    const double later = at + 1 < pieces_.size() ? pieces_[at + 1].begin - piece.begin : 0;
    const double fastest = std::max(std::abs(term.angular_frequency), std::abs(term.angular_frequency + term.sweep * later));
    if (fastest > 0) step = std::min(step, 2 * std::numbers::pi / fastest / steps_per_period);
    if (term.decay > 0) step = std::min(step, 1 / term.decay);
  }
  return step;
}

double last_breakpoint(std::span<const Signal> signals) {
  double last = 0;
  for (const Signal& signal : signals) last = std::max(last, signal.pieces().back().begin);
  return last;
}

Signal held_from(const Signal& signal, double time) {
  if (time == 0) return Signal::standing(signal.before());
  std::vector<SignalPiece> pieces = signal.pieces();
  std::erase_if(pieces, [&](const SignalPiece& piece) { return piece.begin >= time; });
  if (!pieces.back().is_level()) pieces.push_back({.begin = time, .value = signal.voltage_before(time)});
  return Signal(std::move(pieces), signal.before());
}

Signal part_from(const Signal& signal, double time, double before) {
  std::vector<SignalPiece> pieces;
  for (std::size_t k = signal.piece_at(time); k < signal.pieces().size(); ++k) {
    SignalPiece piece = signal.pieces()[k];
    if (piece.begin < time) piece = {.begin = time, .value = signal.voltage(time)};
    if (piece.oscillates()) piece.phase += piece.angular_frequency * time;
    piece.begin -= time;
    pieces.push_back(std::move(piece));
  }
  return Signal(std::move(pieces), before);
}

Signal scaled(const Signal& signal, double factor) {
  std::vector<SignalPiece> pieces = signal.pieces();
  for (SignalPiece& piece : pieces) {
    for (double SignalPiece::*level :
         {&SignalPiece::value, &SignalPiece::slope, &SignalPiece::amplitude, &SignalPiece::amplitude_slope}) {
      piece.*level *= factor;
    }
    for (SignalTerm& term : piece.terms) {
      for (double& coefficient : term.cosine) coefficient *= factor;
      for (double& coefficient : term.sine) coefficient *= factor;
    }
  }
  return Signal(std::move(pieces), factor * signal.before());
}

}  // namespace softland
