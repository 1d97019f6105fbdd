#include "waveforms/driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "base/require.h"
#include "waveforms/bounds.h"

namespace softland {
namespace {

using Complex = std::complex<double>;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A part Re[polynomial(s) exp(exponent s)] of a voltage signal; the time s counts from the beginning of the signal piece.
struct Exponential {
  std::array<Complex, 4> polynomial = {};
  Complex exponent = {};

  [[nodiscard]] bool is_polynomial() const { return exponent == Complex{}; }
};

Exponential exponential_of(const SignalTerm& term) {
  Exponential e{.polynomial = {}, .exponent = {-term.decay, term.angular_frequency}};
  for (std::size_t k = 0; k < term.cosine.size(); ++k) e.polynomial[k] = {term.cosine[k], -term.sine[k]};
  return e;
}

/// Returns all parts of a signal piece without a frequency sweep: straight line, sine and terms.
std::vector<Exponential> exponentials_of(const SignalPiece& piece) {
  std::vector<Exponential> all{{.polynomial = {piece.value, piece.slope}}};
  if (piece.oscillates()) {
    const Complex turned = Complex(0, -1) * std::polar(1.0, piece.angular_frequency * piece.begin + piece.phase);
    all.push_back(
        {.polynomial = {piece.amplitude * turned, piece.amplitude_slope * turned}, .exponent = {0, piece.angular_frequency}});
  }
  for (const SignalTerm& term : piece.terms) all.push_back(exponential_of(term));
  return all;
}

/// Returns the particular solution V of the filter T dV/dt + V = input that has the exponent of the input.
Exponential answer(const Exponential& input, double time_constant) {
  // Relative difference below which the input counts as decaying at the rate of the filter itself. The solution then has a
  // factor proportional to time.
  constexpr double same = 1e-6;
  const Complex factor = 1.0 + input.exponent * time_constant;
  Exponential out{.polynomial = {}, .exponent = input.exponent};
  if (std::abs(factor) > same) {
    Complex above = 0;
    for (std::size_t k = out.polynomial.size(); k-- > 0;) {
      out.polynomial[k] = (input.polynomial[k] - time_constant * static_cast<double>(k + 1) * above) / factor;
      above = out.polynomial[k];
    }
  } else {
    for (std::size_t k = 0; k + 1 < out.polynomial.size(); ++k)
      out.polynomial[k + 1] = input.polynomial[k] / (time_constant * static_cast<double>(k + 1));
  }
  return out;
}

/// Returns the same function as `e`, with its time s counted from a beginning that is `by` [s] later.
Exponential later(const Exponential& e, double by) {
  Exponential moved{.polynomial = {}, .exponent = e.exponent};
  const auto& p = e.polynomial;
  moved.polynomial = {p[0] + by * (p[1] + by * (p[2] + by * p[3])), p[1] + by * (2.0 * p[2] + by * 3.0 * p[3]),
                      p[2] + 3.0 * by * p[3], p[3]};
  const Complex left = std::exp(e.exponent * by);
  for (Complex& c : moved.polynomial) c *= left;
  return moved;
}

SignalPiece piece_of(double begin, const std::vector<Exponential>& parts) {
  SignalPiece piece{.begin = begin};
  for (const Exponential& e : parts) {
    const auto& p = e.polynomial;
    const bool is_steady_sine = e.exponent.real() == 0 && p[1] == 0.0 && p[2] == 0.0 && p[3] == 0.0 && !piece.oscillates();
    if (e.is_polynomial()) {
      piece.value += p[0].real();
      piece.slope += p[1].real();
      if (p[2] != 0.0 || p[3] != 0.0) piece.terms.push_back({.cosine = {0, 0, p[2].real(), p[3].real()}});
    } else if (is_steady_sine) {
      piece.amplitude = std::abs(p[0]);
      piece.angular_frequency = e.exponent.imag();
      piece.phase = std::arg(p[0]) + std::numbers::pi / 2 - piece.angular_frequency * begin;
    } else {
      SignalTerm term{.decay = -e.exponent.real(), .angular_frequency = e.exponent.imag()};
      for (std::size_t k = 0; k < p.size(); ++k) term.cosine[k] = p[k].real(), term.sine[k] = -p[k].imag();
      piece.terms.push_back(term);
    }
  }
  return piece;
}

/// Returns true if the voltage of a signal piece is constant, as that of a sample held by a converter.
bool is_held_level(const SignalPiece& piece) { return piece.slope == 0 && !piece.oscillates() && piece.terms.empty(); }

/// Returns the response of the filter T dV/dt + V = input to a constant level. `left` is the difference of output and level at
/// the beginning of the piece [V], which decays.
SignalPiece answer_to_level(const SignalPiece& level, double time_constant, double left) {
  SignalPiece piece{.begin = level.begin, .value = level.value};
  if (left != 0) piece.terms.push_back({.cosine = {left}, .decay = 1 / time_constant});
  return piece;
}

/// Replaces signal pieces with a frequency sweep by cubic pieces that have the same values and slopes at both ends.
std::vector<SignalPiece> without_sweeps(const std::vector<SignalPiece>& pieces) {
  constexpr double tolerance = 1e-6;  // largest error of these cubics, relative to the size of sine and terms
  std::vector<SignalPiece> all;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const SignalPiece& piece = pieces[i];
    if (std::none_of(piece.terms.begin(), piece.terms.end(), [](const SignalTerm& term) { return term.sweep != 0; })) {
      all.push_back(piece);
      continue;
    }
    // A cubic with the values and slopes of f at both ends of an interval of length h differs from f by at most h^4 / 384 times
    // the largest fourth derivative.
    const double end = pieces[i + 1].begin, size = internal::derivative_bound(piece, 0, piece.begin, end);
    const double fourth = internal::derivative_bound(piece, 4, piece.begin, end);
    const double count = std::max(1.0, std::ceil((end - piece.begin) * std::pow(fourth / (384 * tolerance * size), 0.25)));
    constexpr double most = 1e6;
    require(count <= most, fmt::format("a chirp needs {} cubics to be filtered; it must need at most {}", count, most));
    for (double k = 0; k < count; ++k) {
      const double from = piece.begin + (end - piece.begin) * (k / count),
                   to = piece.begin + (end - piece.begin) * ((k + 1) / count);
      const double h = to - from, v0 = piece.voltage(from), v1 = piece.voltage(to), r0 = piece.rate(from), r1 = piece.rate(to);
      if (!(h > 0)) continue;
      const double rise = (v1 - v0) / h;
      SignalPiece cubic{.begin = from, .value = v0, .slope = r0};
      cubic.terms.push_back({.cosine = {0, 0, (3 * rise - 2 * r0 - r1) / h, (r0 + r1 - 2 * rise) / (h * h)}});
      all.push_back(cubic);
    }
  }
  return all;
}

}  // namespace

namespace internal {
namespace {

/// Returns the voltage step between two neighbouring codes of a converter with this number of bits [V].
double step_of(const DriverLimits& limits, int bits) { return (limits.max_voltage - limits.min_voltage) / (std::exp2(bits) - 1); }

}  // namespace

Signal sampled(const Signal& commanded, double rate, std::optional<int> bits, const DriverLimits& limits, double end) {
  const SignalPiece& last = commanded.pieces().back();
  double until = last.begin + duration_of_terms(last);
  if (last.oscillates()) until = std::max(until, end);
  const auto rounded = [&](double voltage) {
    if (!bits) return voltage;
    const double step = step_of(limits, *bits);
    const double inside = std::clamp(voltage, limits.min_voltage, limits.max_voltage);
    return std::min(limits.min_voltage + step * std::round((inside - limits.min_voltage) / step), limits.max_voltage);
  };
  const double count = std::ceil(until * rate);
  constexpr double most = 1e7;
  require(count <= most,
          fmt::format("a waveform of {} s has {} samples at {} Hz; it must have at most {}", until, count, rate, most));
  std::vector<SignalPiece> pieces;
  const auto hold = [&](double time, double voltage) {
    if (pieces.empty() || pieces.back().value != voltage) pieces.push_back({.begin = time, .value = voltage});
  };
  for (double k = 0; k < count; ++k) hold(k / rate, rounded(commanded.voltage(k / rate)));
  hold(count / rate, rounded(commanded.hold_level()));
  return Signal(std::move(pieces), commanded.before());
}

Signal slewed(const Signal& held, double max_slew) {
  const std::vector<SignalPiece>& pieces = held.pieces();
  std::vector<SignalPiece> all;
  double output = held.before();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double begin = pieces[i].begin, target = pieces[i].value;
    const double next = i + 1 < pieces.size() ? pieces[i + 1].begin : infinite;
    const double reached = begin + std::abs(target - output) / max_slew;
    const bool meets = std::isfinite(next) && coincide(reached, next);
    if (reached > begin && (meets || reached >= next)) {
      const double slope = meets ? (target - output) / (next - begin) : std::copysign(max_slew, target - output);
      all.push_back({.begin = begin, .value = output, .slope = slope});
      output = meets ? target : output + slope * (next - begin);
      continue;
    }
    if (reached > begin) all.push_back({.begin = begin, .value = output, .slope = (target - output) / (reached - begin)});
    all.push_back({.begin = std::max(reached, begin), .value = target});
    output = target;
  }
  return Signal(std::move(all), held.before());
}

Signal filtered(const Signal& input, double time_constant) {
  constexpr double over = 40;  // number of time constants after which a decaying response is dropped
  const std::vector<SignalPiece> pieces = without_sweeps(input.pieces());
  std::vector<SignalPiece> all;
  double output = input.before();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double begin = pieces[i].begin, end = i + 1 < pieces.size() ? pieces[i + 1].begin : infinite;
    // Use a faster formula for constant levels, since a sampled waveform has thousands of levels.
    if (is_held_level(pieces[i])) {
      const double left = begin + over * time_constant;
      const bool settles = output != pieces[i].value;
      all.push_back(answer_to_level(pieces[i], time_constant, output - pieces[i].value));
      if (settles && left < end && left > begin) all.push_back({.begin = left, .value = pieces[i].value});
      if (std::isfinite(end)) output = all.back().voltage(end);
      continue;
    }
    std::vector<Exponential> parts;
    double steady = 0;
    for (const Exponential& e : exponentials_of(pieces[i])) {
      parts.push_back(answer(e, time_constant));
      steady += parts.back().polynomial[0].real();
    }
    const double left = begin + over * time_constant;
    const bool is_cut = left < end && left > begin;
    std::vector<Exponential> with_tail = parts;
    if (output != steady) with_tail.push_back({.polynomial = {output - steady}, .exponent = -1 / time_constant});
    all.push_back(piece_of(begin, with_tail));
    if (is_cut && output != steady) {
      for (Exponential& e : parts) e = later(e, left - begin);
      all.push_back(piece_of(left, parts));
    }
    if (std::isfinite(end)) output = all.back().voltage(end);
  }
  return Signal(std::move(all), input.before());
}

}  // namespace internal

DriverLimits limits_of_samples(DriverLimits limits, const DriverModel& model) {
  constexpr double rounding = 1e-9;  // relative rounding error of the slew between two samples at late times
  if (model.sample_rate) limits.max_slew *= 1 + rounding;
  if (model.sample_rate && model.bits) limits.max_slew += internal::step_of(limits, *model.bits) * *model.sample_rate;
  return limits;
}

Signal held(const Signal& commanded, const DriverModel& model, const DriverLimits& limits, double end) {
  if (!model.sample_rate || commanded.is_zero()) return commanded;
  return internal::sampled(commanded, *model.sample_rate, model.bits, limits, end);
}

Signal commanded_samples(const Signal& commanded, const DriverModel& model, const DriverLimits& limits, double end) {
  const Signal samples = held(commanded, model, limits, end);
  if (!model.sample_rate || commanded.voltage(0) != commanded.before()) return samples;
  std::vector<SignalPiece> pieces = samples.pieces();
  pieces.front().value = commanded.before();
  return Signal(std::move(pieces), samples.before());
}

Signal applied(const Signal& commanded, const DriverModel& model, const DriverLimits& limits, double end,
               const SourceErrors& errors) {
  Signal output = held(commanded, model, limits, end);
  if (model.sample_rate && std::isfinite(limits.max_slew) && !commanded.is_zero())
    output = internal::slewed(output, limits.max_slew);
  if (!errors.are_none()) output = with_errors(output, errors);
  if (model.is_ideal() || output.is_zero()) return output;
  if (model.bandwidth) output = internal::filtered(output, 1 / (2 * std::numbers::pi * *model.bandwidth));
  if (const double charging = model.charging_time(); charging > 0) output = internal::filtered(output, charging);
  return output;
}

}  // namespace softland
