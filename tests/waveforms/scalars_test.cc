// Waveform families over the three scalars of their parameters: a number, a lane with one number for each device, and a dual
// number with a direction for each parameter.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <experimental/simd>

#include "base/require.h"
#include "waveforms/bspline.h"
#include "waveforms/chirp.h"
#include "waveforms/harmonic.h"
#include "waveforms/pulse.h"
#include "waveforms/s_curve.h"
#include "waveforms/sines.h"
#include "waveforms/step.h"
#include "waveforms/table.h"

namespace softland::scalars_test {
namespace {

constexpr std::size_t devices = 4;
using DeviceLane = std::experimental::fixed_size_simd<double, devices>;

/// A number with N derivatives by parameters of a waveform. It stands for the model's dual numbers, which this folder cannot
/// include.
template <std::size_t N>
struct Sloped {
  double value = 0;
  std::array<double, N> slopes = {};

  Sloped(double v = 0) : value(v) {}
  Sloped(double v, std::size_t k) : value(v) { slopes[k] = 1; }

  static Sloped of(double value, const Sloped& a, double by_a, const Sloped& b, double by_b) {
    Sloped c(value);
    for (std::size_t k = 0; k < N; ++k) c.slopes[k] = by_a * a.slopes[k] + by_b * b.slopes[k];
    return c;
  }
  friend Sloped operator+(const Sloped& a, const Sloped& b) { return of(a.value + b.value, a, 1, b, 1); }
  friend Sloped operator-(const Sloped& a, const Sloped& b) { return of(a.value - b.value, a, 1, b, -1); }
  friend Sloped operator*(const Sloped& a, const Sloped& b) { return of(a.value * b.value, a, b.value, b, a.value); }
  friend Sloped operator/(const Sloped& a, const Sloped& b) {
    return of(a.value / b.value, a, 1 / b.value, b, -a.value / (b.value * b.value));
  }
  friend Sloped sin(const Sloped& a) { return of(std::sin(a.value), a, std::cos(a.value), a, 0); }
  friend Sloped cos(const Sloped& a) { return of(std::cos(a.value), a, -std::sin(a.value), a, 0); }
  friend Sloped exp(const Sloped& a) { return of(std::exp(a.value), a, std::exp(a.value), a, 0); }
  friend Sloped abs(const Sloped& a) { return a.value < 0 ? Sloped(0) - a : a; }
  friend bool operator<(const Sloped& a, const Sloped& b) { return a.value < b.value; }
  friend bool operator>(const Sloped& a, const Sloped& b) { return a.value > b.value; }
};

/// Returns the voltage of the piece that is valid at this time in every device.
template <class P>
P voltage(const Pieces<P>& pieces, double time) {
  std::size_t k = 0;
  while (k + 1 < pieces.size() && !internal::decided(P(time) < pieces[k + 1].begin)) ++k;
  return pieces[k].voltage(P(time));
}
template <class P>
P rate(const Pieces<P>& pieces, double time) {
  std::size_t k = 0;
  while (k + 1 < pieces.size() && !internal::decided(P(time) < pieces[k + 1].begin)) ++k;
  return pieces[k].rate(P(time));
}

struct AStep {
  static constexpr std::array parameters{40.0, 5e-6};
  template <class P>
  static auto make(const std::array<P, 2>& p) {
    return StepOf<P>{.level = p[0], .rise_time = p[1]};
  }
};
struct APulse {
  static constexpr std::array parameters{40.0, 0.0, 30.0, 20e-6, 45e-6, 4e-6};
  template <class P>
  static auto make(const std::array<P, 6>& p) {
    return PulseOf<P>{.levels = {p[0], p[1], p[2]}, .times = {p[3], p[4]}, .edge = p[5]};
  }
};
/// The second edge begins at the end of the first one.
struct AStaircase {
  static constexpr std::array parameters{40.0, 30.0, 4e-6};
  template <class P>
  static auto make(const std::array<P, 3>& p) {
    return PulseOf<P>{.levels = {p[0], p[1]}, .times = {p[2]}, .edge = p[2]};
  }
};
struct AHarmonic {
  static constexpr std::array parameters{40.0, 5e-6, 3.0, 2e5, 0.3, 10e-6, 60e-6, 7e-6};
  template <class P>
  static auto make(const std::array<P, 8>& p) {
    return HarmonicOf<P>{.base = p[0],
                         .rise_time = p[1],
                         .amplitude = p[2],
                         .angular_frequency = p[3],
                         .phase = p[4],
                         .start = p[5],
                         .end = p[6],
                         .fade = p[7]};
  }
};
/// Parameters with the value 0 have derivatives as well.
struct ASilentHarmonic {
  static constexpr std::array parameters{0.0, 5e-6, 0.0, 2e5, 0.3};
  template <class P>
  static auto make(const std::array<P, 5>& p) {
    return HarmonicOf<P>{.base = p[0], .rise_time = p[1], .amplitude = p[2], .angular_frequency = p[3], .phase = p[4]};
  }
};

/// A table with a jump: two rows with the same time.
struct ATable {
  static constexpr std::array parameters{5.0, 40.0, 10.0, 30.0, 10e-6, 25e-6, 50e-6};
  template <class P>
  static auto make(const std::array<P, 7>& p) {
    return TableOf<P>{.time = {P(0), p[4], p[5], p[5], p[6]}, .voltage = {p[0], p[1], p[1] + P(1), p[2], p[3]}};
  }
};

struct ASCurve {
  static constexpr std::array parameters{40.0, 0.0, 30.0, 20e-6, 45e-6, 4e-6};
  template <class P>
  static auto make(const std::array<P, 6>& p) {
    return SCurveOf<P>{.levels = {p[0], p[1], p[2]}, .times = {p[3], p[4]}, .edge = p[5]};
  }
};
struct AChirp {
  static constexpr std::array parameters{40.0, 5e-6, 3.0, 2e5, 1.7, 0.3, 10e-6, 60e-6, 7e-6, 30e-6};
  template <class P>
  static auto make(const std::array<P, 10>& p) {
    return ChirpOf<P>{.base = p[0],
                      .rise_time = p[1],
                      .amplitude = p[2],
                      .angular_frequency = p[3],
                      .frequency_ratio = p[4],
                      .phase = p[5],
                      .start = p[6],
                      .end = p[7],
                      .fade = p[8],
                      .decay_time = p[9]};
  }
};
struct ABSpline {
  static constexpr std::array parameters{40.0, 0.0, 30.0, 35.0, 28.0, 64e-6};
  template <class P>
  static auto make(const std::array<P, 6>& p) {
    return BSplineOf<P>{.levels = {p[0], p[1], p[2], p[3], p[4]}, .duration = p[5]};
  }
};
struct SomeSines {
  static constexpr std::array parameters{40.0, 5e-6, -20.0, 0.0, 5.0, 6e-6, 55e-6};
  template <class P>
  static auto make(const std::array<P, 7>& p) {
    return SinesOf<P>{.base = p[0], .rise_time = p[1], .amplitudes = {p[2], p[3], p[4]}, .start = p[5], .duration = p[6]};
  }
};

constexpr std::array times{1e-6, 3.3e-6, 12e-6, 21.5e-6, 30e-6, 46e-6, 58e-6, 80e-6};

template <class Family>
class ScalarsOf : public testing::Test {};
using Families =
    testing::Types<AStep, APulse, AStaircase, AHarmonic, ASilentHarmonic, ATable, ASCurve, AChirp, ABSpline, SomeSines>;
TYPED_TEST_SUITE(ScalarsOf, Families);

TYPED_TEST(ScalarsOf, EveryDeviceOfALaneHasItsOwnSignal) {
  constexpr std::size_t count = TypeParam::parameters.size();
  const auto parameters_of = [](std::size_t device) {
    auto p = TypeParam::parameters;
    for (double& one : p) one *= 1 + 1e-3 * static_cast<double>(device);
    return p;
  };
  std::array<DeviceLane, count> parameters;
  for (std::size_t k = 0; k < count; ++k) parameters[k] = DeviceLane([&](auto i) { return parameters_of(i)[k]; });
  const auto all = pieces(TypeParam::template make<DeviceLane>(parameters));
  for (const double t : times) {
    const DeviceLane volts = voltage(all, t);
    for (std::size_t i = 0; i < devices; ++i) {
      const Signal alone = signal(TypeParam::template make<double>(parameters_of(i)));
      EXPECT_NEAR(volts[i], alone.voltage(t), 1e-11) << "device " << i << ", " << t << " s";
    }
  }
}

TYPED_TEST(ScalarsOf, SlopesAreThoseOfEveryParameter) {
  constexpr std::size_t count = TypeParam::parameters.size();
  std::array<Sloped<count>, count> parameters;
  for (std::size_t k = 0; k < count; ++k) parameters[k] = {TypeParam::parameters[k], k};
  const auto all = pieces(TypeParam::template make<Sloped<count>>(parameters));
  for (const double t : times) {
    const Sloped<count> volts = voltage(all, t), slope = rate(all, t);
    const Signal alone = signal(TypeParam::template make<double>(TypeParam::parameters));
    EXPECT_NEAR(volts.value, alone.voltage(t), 1e-12) << t;
    // Phases of hundreds of radians have rounding errors if a compiler fuses products and sums.
    EXPECT_NEAR(slope.value, alone.pieces()[alone.piece_at(t)].rate(t), 1e-11 * std::abs(slope.value)) << t;
    for (std::size_t k = 0; k < count; ++k) {
      const double size = TypeParam::parameters[k] == 0 ? 1 : TypeParam::parameters[k];
      const auto moved = [&](double share) {
        auto p = TypeParam::parameters;
        p[k] += share * size;
        return signal(TypeParam::template make<double>(p)).voltage(t);
      };
      const auto central = [&](double share) { return (moved(share) - moved(-share)) / (2 * share); };
      EXPECT_NEAR(volts.slopes[k] * size, (4 * central(1e-4) - central(2e-4)) / 3, 1e-6)
          << "parameter " << k << ", " << t << " s";
    }
  }
}

TEST(Pieces, OfALaneAreTheSameInAllItsDevices) {
  // Only in some devices the edge ends where the next one begins.
  const DeviceLane edge([](auto i) { return 4e-6 - 1e-7 * static_cast<double>(i); });
  EXPECT_THROW((void)pieces(PulseOf<DeviceLane>{.levels = {40.0, 30.0}, .times = {4e-6}, .edge = edge}), InvalidInput);
}

}  // namespace
}  // namespace softland::scalars_test
