// The smooth pieces that a voltage signal is made of. They are templates over the scalar type P of voltages and times: a
// double, a dual number with derivatives by the parameters of a waveform, or a SIMD vector with one number per device.
//
//   V(t) = value + slope s + [amplitude + amplitude_slope s] sin(angular_frequency t + phase) + terms,  s = t - begin
//
// on [begin, begin of the next piece); the last piece has no end. Few pieces have terms: polynomials, exponentials, sines that
// decay or whose frequency changes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/require.h"
#include "base/select.h"

namespace softland {

namespace internal {

/// Returns true if a number is the constant 0. A dual number or a SIMD vector is not constant, even if its value is 0.
template <class P>
[[nodiscard]] bool vanishes(const P& x) {
  if constexpr (std::is_same_v<P, double>) {
    return x == 0;
  } else {
    return false;
  }
}

}  // namespace internal

/// One smooth part (term) of the voltage of a signal piece:
///
///   exp(-decay s) [C(s) cos a + S(s) sin a],  a = angular_frequency s + sweep s^2 / 2,  s = t - begin of the piece
///
/// with cubic polynomials C and S, their coefficients in rising order. Without decay and angle it is the polynomial C.
template <class P>
struct TermOf {
  using Cubic = std::array<P, 4>;

  Cubic cosine = {};        ///< coefficients of the cosine's polynomial C: [V], [V/s], [V/s^2], [V/s^3]
  Cubic sine = {};          ///< coefficients of the sine's polynomial S: [V], [V/s], [V/s^2], [V/s^3]
  P decay = 0;              ///< decay rate of the term [1/s]
  P angular_frequency = 0;  ///< angular frequency of the term at the beginning of the signal piece [rad/s]
  P sweep = 0;              ///< rate of change of the angular frequency [rad/s^2]

  [[nodiscard]] bool turns() const { return !internal::vanishes(angular_frequency) || !internal::vanishes(sweep); }
  /// Returns the voltage of the term [V] at time s after the beginning of the signal piece.
  [[nodiscard]] P voltage(const P& s) const {
    using std::cos, std::exp, std::sin;
    P sum = at(cosine, s);
    if (turns()) {
      const P angle = (angular_frequency + P(0.5) * sweep * s) * s;
      sum = sum * cos(angle) + at(sine, s) * sin(angle);
    }
    return internal::vanishes(decay) ? sum : sum * exp(P(0) - decay * s);
  }
  /// Returns dV/dt of the term [V/s] at time s after the beginning of the signal piece.
  [[nodiscard]] P rate(const P& s) const {
    using std::cos, std::exp, std::sin;
    const P c = at(cosine, s);
    P sum = slope(cosine, s) - decay * c;
    if (turns()) {
      const P angle = (angular_frequency + P(0.5) * sweep * s) * s, turning = angular_frequency + sweep * s, d = at(sine, s);
      sum = (sum + turning * d) * cos(angle) + (slope(sine, s) - decay * d - turning * c) * sin(angle);
    }
    return internal::vanishes(decay) ? sum : sum * exp(P(0) - decay * s);
  }
  bool operator==(const TermOf&) const = default;

 private:
  [[nodiscard]] static P at(const Cubic& c, const P& s) { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }
  [[nodiscard]] static P slope(const Cubic& c, const P& s) { return c[1] + s * (P(2) * c[2] + s * (P(3) * c[3])); }
};

template <class P>
struct SignalPieceOf {
  P begin = 0;                        ///< time at which the piece begins [s]
  P value = 0;                        ///< voltage of the straight line at begin [V]
  P slope = 0;                        ///< slope of the straight line's voltage [V/s]
  P amplitude = 0;                    ///< amplitude of the sine at begin [V]
  P amplitude_slope = 0;              ///< rate of change of the sine's amplitude [V/s]
  P angular_frequency = 0;            ///< angular frequency of the sine [rad/s]
  P phase = 0;                        ///< phase of sin(angular_frequency t + phase) [rad], with t from 0, not from begin
  std::vector<TermOf<P>> terms = {};  ///< further parts of the voltage, whose time s counts from begin
  /// True if the terms are a Fourier series: sines and cosines of constant amplitude, whose angular frequencies are 1, 2, 3 ...
  /// times that of the first term. Their values are then computed from those of the first by addition theorems.
  bool is_series = false;

  [[nodiscard]] bool oscillates() const { return !internal::vanishes(amplitude) || !internal::vanishes(amplitude_slope); }
  /// Returns true if the signal piece is a straight line, without sine and terms.
  [[nodiscard]] bool is_straight() const { return !oscillates() && terms.empty(); }
  /// Returns true if the voltage of the signal piece is constant.
  [[nodiscard]] bool is_level() const { return internal::vanishes(slope) && is_straight(); }
  /// Returns the voltage of the signal piece [V]. The formula continues past both ends of the piece, so that an integrator may
  /// step a little beyond a breakpoint.
  [[nodiscard]] P voltage(P time) const {
    using std::sin;
    const P elapsed = time - begin;
    const P straight = value + slope * elapsed;
    if (terms.empty()) [[likely]] {
      if (!oscillates()) return straight;
      return straight + (amplitude + amplitude_slope * elapsed) * sin(angular_frequency * time + phase);
    }
    P sum = straight;
    if (oscillates()) sum = sum + (amplitude + amplitude_slope * elapsed) * sin(angular_frequency * time + phase);
    if (is_series) {
      turn_on(elapsed, [&](const TermOf<P>& term, const P& c, const P& s) { sum = sum + term.cosine[0] * c + term.sine[0] * s; });
    } else {
      for (const TermOf<P>& term : terms) sum = sum + term.voltage(elapsed);
    }
    return sum;
  }
  /// Returns dV/dt of the signal piece [V/s].
  [[nodiscard]] P rate(P time) const {
    using std::cos, std::sin;
    const auto swinging = [&] {
      const P angle = angular_frequency * time + phase;
      const P envelope = amplitude + amplitude_slope * (time - begin);
      return slope + amplitude_slope * sin(angle) + envelope * angular_frequency * cos(angle);
    };
    P sum = oscillates() ? swinging() : slope;
    if (is_series) {
      turn_on(time - begin, [&](const TermOf<P>& term, const P& c, const P& s) {
        sum = sum + term.angular_frequency * (term.sine[0] * c - term.cosine[0] * s);
      });
    } else {
      for (const TermOf<P>& term : terms) sum = sum + term.rate(time - begin);
    }
    return sum;
  }
  bool operator==(const SignalPieceOf&) const = default;

 private:
  // Calls see(term, cosine, sine) for every term of a Fourier series, with the cosine and the sine of the term's phase angle.
  template <class See>
  void turn_on(const P& elapsed, See&& see) const {
    using std::cos, std::sin;
    const P angle = terms.front().angular_frequency * elapsed, c1 = cos(angle), s1 = sin(angle);
    P c = c1, s = s1;
    for (const TermOf<P>& term : terms) {
      see(term, c, s);
      const P next = c * c1 - s * s1;
      s = s * c1 + c * s1;
      c = next;
    }
  }
};
template <class P>
using Pieces = std::vector<SignalPieceOf<P>>;

namespace internal {

/// Returns true if a comparison of a waveform's times holds. For SIMD vectors, throws InvalidInput if it holds for some devices
/// only, because the signals of the devices would then have different pieces.
template <class Condition>
[[nodiscard]] bool decided(const Condition& condition) {
  if constexpr (std::is_same_v<Condition, bool>) {
    return condition;
  } else {
    require(all_of(condition) || none_of(condition), "the signals of the devices of a lane must have the same pieces");
    return all_of(condition);
  }
}

/// Returns true for two times [s] that differ only by rounding, of a sum or of decimal text. Such times count as equal, as
/// where one voltage ramp ends and the next begins: a signal piece between them would be too short for any integrator.
template <class P>
[[nodiscard]] bool coincide(const P& time, const P& other) {
  using std::abs;
  constexpr double roundings = 4, epsilon = 0x1p-52;
  return !decided(abs(time - other) > roundings * epsilon * abs(other));
}

/// Returns the signal pieces of straight lines between points (time [s], voltage [V]), in order of time; two points of equal
/// time are a jump.
template <class P>
[[nodiscard]] Pieces<P> straight_pieces(const std::vector<std::pair<P, P>>& points) {
  Pieces<P> pieces;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto& [time, voltage] = points[i];
    const auto& [next_time, next_voltage] = points[i + 1];
    if (!decided(next_time > time)) continue;
    pieces.push_back({.begin = time, .value = voltage, .slope = (next_voltage - voltage) / (next_time - time)});
  }
  pieces.push_back({.begin = points.back().first, .value = points.back().second});
  return pieces;
}

/// One straight part of a piecewise linear function of time. It ends where the next part begins; the last one has no end.
template <class P>
struct StraightPart {
  P begin = 0;  ///< time at which the straight part begins [s]
  P value = 0;  ///< value of the piecewise linear function at begin
  P slope = 0;  ///< slope of the function on this part [1/s]

  [[nodiscard]] P at(const P& time) const { return value + slope * (time - begin); }
};

/// Returns the straight part of the piecewise linear function `line` at `time`; at a boundary the later part.
template <class P>
[[nodiscard]] const StraightPart<P>& part_at(const std::vector<StraightPart<P>>& line, const P& time) {
  std::size_t found = 0;
  while (found + 1 < line.size() && !decided(time < line[found + 1].begin)) ++found;
  return line[found];
}

}  // namespace internal
}  // namespace softland
