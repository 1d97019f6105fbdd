// Pieces beyond straight lines and sines: polynomials, exponentials, sines that decay or change their frequency.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/not_finite.h"
#include "tests/waveforms/expect_invalid.h"
#include "waveforms/bounds.h"
#include "waveforms/export.h"
#include "waveforms/signal.h"
#include "waveforms/source_errors.h"

namespace softland {
namespace {

using test::expect_invalid;

// The error of the extrema of terms that signal.h states, relative to their size.
constexpr double kPromisedTermExtremum = 1e-9;

/// Returns terms of every kind, with times and voltages of order one.
SignalPiece random_piece(std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-1, 1), positive(0, 1);
  SignalPiece piece{.value = any(random), .slope = any(random)};
  if (random() % 2 == 0) {
    piece.amplitude = any(random);
    piece.angular_frequency = 20 * positive(random) + 0.1;
    piece.phase = any(random);
  }
  for (auto more = 1 + random() % 3; more > 0; --more) {
    SignalTerm term{.decay = random() % 2 == 0 ? 0 : 10 * positive(random),
                    .angular_frequency = random() % 3 == 0 ? 0 : 30 * positive(random),
                    .sweep = random() % 2 == 0 ? 0 : 20 * any(random)};
    for (double& c : term.cosine) c = random() % 2 == 0 ? 0 : any(random);
    for (double& c : term.sine) c = random() % 2 == 0 ? 0 : any(random);
    piece.terms.push_back(term);
  }
  return piece;
}

Signal with_end(const SignalPiece& piece, double end) { return Signal({piece, {.begin = end, .value = piece.voltage(end)}}); }

TEST(Terms, RateIsTheDerivativeOfVoltage) {
  std::mt19937_64 random(3);
  constexpr double h = 1e-5;
  for (int i = 0; i < 200; ++i) {
    const SignalPiece piece = random_piece(random);
    for (double t = 0; t < 1.5; t += 0.1) {
      // A central difference has an error of h^2 / 6 of the third derivative, and of rounding over h.
      const double third = internal::derivative_bound(piece, 3, t - h, t + h);
      EXPECT_NEAR(piece.rate(t), (piece.voltage(t + h) - piece.voltage(t - h)) / (2 * h), h * h / 6 * third + 1e-9) << i;
    }
  }
}

TEST(Terms, BoundsHoldEveryDifferenceQuotient) {
  std::mt19937_64 random(4);
  constexpr double h = 1e-3;
  for (int i = 0; i < 200; ++i) {
    SignalPiece piece = random_piece(random);
    piece.begin = i % 2;
    if (piece.oscillates()) piece.amplitude_slope = 0.5 * (i % 3 - 1);
    if (i % 4 == 1) piece.terms.clear();
    const double begin = piece.begin, end = begin + 1;
    const double second = internal::derivative_bound(piece, 2, begin, end),
                 third = internal::derivative_bound(piece, 3, begin, end);
    for (double t = begin + h; t < end - h; t += 0.017) {
      // Means of the second and of the third derivative over 2 h.
      EXPECT_LE(std::abs(piece.voltage(t + h) - 2 * piece.voltage(t) + piece.voltage(t - h)) / (h * h), second + 1e-8);
      EXPECT_LE(std::abs(piece.rate(t + h) - 2 * piece.rate(t) + piece.rate(t - h)) / (h * h), third + 1e-6);
    }
  }
}

TEST(Terms, ExtremaMatchDenseSampling_long) {
  std::mt19937_64 random(5);
  constexpr double duration = 1.3;
  constexpr int samples = 20000;
  for (int i = 0; i < 60; ++i) {
    SignalPiece piece = random_piece(random);
    piece.value -= piece.voltage(0);  // removes the jump at the start
    const Signal signal = with_end(piece, duration);
    double largest = 0, smallest = 0, fastest = 0;
    for (int k = 0; k <= samples; ++k) {
      const double t = duration * k / samples;
      largest = std::max(largest, piece.voltage(t));
      smallest = std::min(smallest, piece.voltage(t));
      fastest = std::max(fastest, std::abs(piece.rate(t)));
    }
    // Twelve coefficients of at most 1 and powers of at most 1.3^3; a rate is at most 60 times that.
    constexpr double size = 60, rates = 60 * size;
    const double h = duration / samples;
    const double below = h * h / 8 * internal::derivative_bound(piece, 2, 0, duration);
    const double slower = h * h / 8 * internal::derivative_bound(piece, 3, 0, duration);
    EXPECT_GE(signal.maximum(), largest - kPromisedTermExtremum * size) << i;
    EXPECT_LE(signal.maximum(), largest + below + 1e-12) << i;
    EXPECT_LE(signal.minimum(), smallest + kPromisedTermExtremum * size) << i;
    EXPECT_GE(signal.minimum(), smallest - below - 1e-12) << i;
    EXPECT_GE(signal.peak_slew(), fastest - kPromisedTermExtremum * rates) << i;
    EXPECT_LE(signal.peak_slew(), fastest + slower + 1e-9) << i;
  }
}

TEST(Terms, ExtremaOfACubicAndOfADecayMatchTheClosedForm) {
  // t - t^3 has its maximum 2 / sqrt(27) at 1 / sqrt(3).
  const Signal cubic = with_end({.slope = 1, .terms = {{.cosine = {0, 0, 0, -1}}}}, 1);
  EXPECT_NEAR(cubic.maximum(), 2 / std::sqrt(27.0), kPromisedTermExtremum * 2);
  EXPECT_NEAR(cubic.peak_slew(), 2, kPromisedTermExtremum * 4);
  // t exp(-t) has its maximum 1 / e at 1, and never ends.
  const Signal decay({{.terms = {{.cosine = {0, 1, 0, 0}, .decay = 1}}}});
  EXPECT_NEAR(decay.maximum(), 1 / std::numbers::e, kPromisedTermExtremum * 50);
  EXPECT_EQ(decay.minimum(), 0);
  EXPECT_EQ(decay.hold_level(), 0);
  // exp(-a t) sin(w t) has its first maximum where tan(w t) = w / a.
  constexpr double a = 2, w = 7;
  const Signal swing({{.terms = {{.sine = {1, 0, 0, 0}, .decay = a, .angular_frequency = w}}}});
  const double at = std::atan2(w, a) / w;
  EXPECT_NEAR(swing.maximum(), std::exp(-a * at) * std::sin(w * at), kPromisedTermExtremum);
}

TEST(Terms, PolylineStaysWithinItsTolerance) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 60; ++i) {
    const Signal signal = with_end(random_piece(random), 1.3);
    for (const double tolerance : {1e-1, 1e-3}) {
      const auto points = polyline(signal, 1.3, tolerance, 0);
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const auto& [t0, v0] = points[k];
        const auto& [t1, v1] = points[k + 1];
        ASSERT_GE(t1, t0);
        if (!(t1 > t0)) continue;
        for (const double share : {0.25, 0.5, 0.75})
          EXPECT_LE(std::abs(v0 + share * (v1 - v0) - signal.voltage(t0 + share * (t1 - t0))), tolerance + 1e-12) << i;
      }
    }
  }
}

TEST(Terms, ThatEndWhereTheNextPieceBeginsAreNoJump) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 100; ++i) {
    const Signal signal = with_end(random_piece(random), 1.3);
    EXPECT_EQ(signal.voltage_before(1.3), signal.voltage(1.3)) << i;
  }
  // The remaining decay of an exponential is not a jump.
  const Signal decay({{.value = -10, .terms = {{.cosine = {10, 0, 0, 0}, .decay = 40}}}, {.begin = 1, .value = -10}});
  EXPECT_EQ(decay.voltage_before(1), -10);
  EXPECT_NEAR(decay.peak_slew(), 400, 400 * kPromisedTermExtremum * 2);
}

TEST(Terms, AreResolvedByAFractionOfTheirPeriodAndByTheirTimeConstant) {
  const Signal turning({{.terms = {{.sine = {1, 0, 0, 0}, .angular_frequency = 3, .sweep = 2}}}, {.begin = 2}});
  EXPECT_DOUBLE_EQ(turning.resolving_step(0.5), 2 * std::numbers::pi / 7 / 20) << "the frequency rises to 7 rad/s";
  EXPECT_EQ(turning.resolving_step(3), kInfinity);
  const Signal decaying({{.terms = {{.cosine = {1, 0, 0, 0}, .decay = 4}}}});
  EXPECT_DOUBLE_EQ(decaying.resolving_step(0), 0.25);
}

TEST(Terms, ScaleWithTheSignal) {
  std::mt19937_64 random(8);
  const Signal signal = with_end(random_piece(random), 1.3), half = scaled(signal, 0.5);
  for (const double t : {0.0, 0.7, 1.29, 1.3, 2.0}) EXPECT_DOUBLE_EQ(half.voltage(t), 0.5 * signal.voltage(t)) << t;
}

TEST(Terms, ThatLastForEverDecayWithoutSweep) {
  expect_invalid([] { (void)Signal({{.terms = {{.cosine = {1, 0, 0, 0}}}}}); }, {"term of the last piece", "must decay"});
  expect_invalid([] { (void)Signal({{.terms = {{.sine = {1, 0, 0, 0}, .decay = 1, .sweep = 2}}}}); }, {"last piece", "sweep 2"});
  expect_invalid([] { (void)Signal({{.terms = {{.decay = -1}}}, {.begin = 1}}); }, {"decay", "-1", ">= 0"});
  expect_invalid([] { (void)Signal({{.terms = {{.cosine = {0, kNaN, 0, 0}}}}, {.begin = 1}}); }, {"term of piece 1", "finite"});
}

TEST(Terms, AreStretchedBetweenEdgesThatErr) {
  // An edge of half a cosine between two levels moves as a whole. A cubic between two corners is stretched and stays
  // continuous.
  const Signal edge({{.value = 1},
                     {.begin = 1, .value = 2, .terms = {{.cosine = {-1, 0, 0, 0}, .angular_frequency = std::numbers::pi}}},
                     {.begin = 2, .value = 3}});
  EXPECT_EQ(edge_count(edge), 2U);
  const Signal late = with_errors(edge, {.offset = 0.5, .delay = 0.1, .edges = {0, 0.2}});
  for (double t = 0.2; t < 3; t += 0.1) EXPECT_NEAR(late.voltage(t), edge.voltage(t < 1.3 ? 0.5 : t - 0.3) + 0.5, 1e-12) << t;
  const SignalPiece cubic{.begin = 1, .value = 1, .terms = {{.cosine = {0, 1, -2, 3}}}};
  const SignalPiece after{.begin = 2, .value = cubic.voltage(2), .slope = -1};
  const Signal curve({{.value = 1}, cubic, after, {.begin = 3, .value = after.voltage(3)}});
  const Signal moved = with_errors(curve, {.edges = {0, 0.1, 0.2, -0.1}});
  EXPECT_NE(moved.breakpoints(), curve.breakpoints());
  for (std::size_t i = 1; i < moved.breakpoints().size(); ++i) {
    const double t = moved.breakpoints()[i];
    EXPECT_NEAR(moved.voltage_before(t), moved.voltage(t), 1e-12) << t;
    EXPECT_NEAR(moved.voltage(t), curve.voltage(curve.breakpoints()[i]), 1e-12) << t;
  }
}

}  // namespace
}  // namespace softland
