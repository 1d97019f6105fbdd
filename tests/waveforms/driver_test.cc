#include "waveforms/driver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/literals.h"
#include "tests/support/not_finite.h"
#include "tests/waveforms/expect_invalid.h"
#include "waveforms/bspline.h"
#include "waveforms/chirp.h"
#include "waveforms/export.h"
#include "waveforms/harmonic.h"
#include "waveforms/pulse.h"
#include "waveforms/s_curve.h"
#include "waveforms/sines.h"
#include "waveforms/step.h"
#include "waveforms/table.h"
#include "waveforms/waveform.h"

namespace softland {
namespace {

using namespace literals;

const DriverLimits limits{.min_voltage = -10, .max_voltage = 50};
constexpr double kDriverRounding = 1e-12;  // relative to the voltages
constexpr double tau = 2e-6;               // time constant of the filters below [s]

DriverModel of_time_constant(double seconds) { return {.bandwidth = 1 / (2 * std::numbers::pi * seconds)}; }

/// Solves T dV/dt + V = input by the trapezoidal rule with steps h, with an error of h^2 / 12 of second derivatives over the
/// time.
double integrated(const Signal& input, double time_constant, double time) {
  double output = 0;
  std::vector<double> stops = input.breakpoints();
  stops.push_back(kInfinity);
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const double begin = stops[i], end = std::min(stops[i + 1], time);
    if (!(end > begin)) continue;
    constexpr int steps = 20000;
    const double h = (end - begin) / steps;
    const SignalPiece& piece = input.pieces()[i];
    for (int k = 0; k < steps; ++k) {
      const double in = 0.5 * (piece.voltage(begin + k * h) + piece.voltage(begin + (k + 1) * h));
      output = (output * (time_constant - h / 2) + h * in) / (time_constant + h / 2);
    }
  }
  return output;
}

TEST(Driver, OfNoModelAppliesTheCommandedVoltage) {
  const Signal commanded = signal(Pulse{.levels = {40_V, 0_V}, .times = {20_us}, .edge = 1_us});
  EXPECT_EQ(applied(commanded, {}, limits, 1).pieces(), commanded.pieces());
  EXPECT_TRUE(applied(Signal(), {.sample_rate = 1e6, .bits = 3}, limits, 1).is_zero()) << "told nothing it gives nothing";
}

TEST(Driver, OfABandwidthAnswersAStepWithAnExponential) {
  const Signal out = applied(Signal::constant(40_V), of_time_constant(tau), limits, 1);
  for (const double t : {0.0, 0.1e-6, 1e-6, 5e-6, 30e-6})
    EXPECT_NEAR(out.voltage(t), 40 * (1 - std::exp(-t / tau)), 40 * kDriverRounding) << t;
  EXPECT_EQ(out.voltage(1), 40);
  EXPECT_EQ(out.hold_level(), 40);
  EXPECT_NEAR(out.peak_slew(), 40 / tau, 1e-8 * out.peak_slew());
  EXPECT_LE(out.maximum(), 40 * (1 + kDriverRounding));
}

TEST(Driver, ChargesItsLoadThroughItsResistance) {
  const Signal out = applied(Signal::constant(40_V), {.source_resistance = 1e7, .load = 2e-13}, limits, 1);
  EXPECT_NEAR(out.voltage(2e-6), 40 * (1 - std::exp(-1.0)), 40 * kDriverRounding);
  EXPECT_EQ(applied(Signal::constant(40_V), {.source_resistance = 1e7, .load = 0}, limits, 1).pieces(),
            Signal::constant(40_V).pieces());
}

// Returns a ramp after R and C by the trapezoidal rule, with an error of a twelfth of the squared step.
double charged(double slope, double resistance, double capacitance, double until) {
  constexpr int steps = 20'000;
  const double dt = until / steps, x = dt / (2 * resistance * capacitance);
  double voltage = 0;
  for (int k = 0; k < steps; ++k) voltage = ((1 - x) * voltage + x * slope * dt * (2 * k + 1)) / (1 + x);
  return voltage;
}

TEST(Driver, ChargesWhatLiesBesideItsLoad) {
  constexpr double resistance = 1e6, load = 14e-15, beside = 3e-12, slope = 40 / 40e-6;
  const DriverModel model{.source_resistance = resistance, .parallel_capacitance = beside, .load = load};
  EXPECT_DOUBLE_EQ(model.charging_time(), 3.014e-6);
  const Signal out = applied(signal(Step{.level = 40_V, .rise_time = 40_us}), model, limits, 1);
  for (const double t : {0.5e-6, 3e-6, 20e-6})
    EXPECT_NEAR(out.voltage(t), charged(slope, resistance, load + beside, t), 40 * 1e-8) << t;
}

TEST(Driver, OfABandwidthFollowsARampLateByItsTimeConstant) {
  const Signal out = applied(signal(Step{.level = 40_V, .rise_time = 40_us}), of_time_constant(tau), limits, 1);
  const double slope = 40 / 40e-6;
  for (const double t : {1e-6, 10e-6, 39e-6})
    EXPECT_NEAR(out.voltage(t), slope * (t - tau * (1 - std::exp(-t / tau))), 40 * kDriverRounding) << t;
}

TEST(Driver, OfABandwidthTakesThreeDecibelsOfASineOfThatFrequency) {
  const double omega = 1 / tau;
  const Signal commanded = signal(Harmonic{.base = 0, .amplitude = 6_V, .angular_frequency = omega});
  const Signal out = applied(commanded, of_time_constant(tau), limits, 1);
  for (double t = 200e-6; t < 230e-6; t += 1e-6)
    EXPECT_NEAR(out.voltage(t), 6 / std::sqrt(2.0) * std::sin(omega * t - std::numbers::pi / 4), 600 * kDriverRounding) << t;
}

TEST(Driver, FiltersEveryFamilyAsItsEquationDoes) {
  const Harmonic faded{.base = 30_V,
                       .rise_time = 3_us,
                       .amplitude = 5_V,
                       .angular_frequency = 6e5,
                       .phase = 0.3,
                       .start = 5_us,
                       .end = 60_us,
                       .fade = 10_us};
  const Chirp ended{.base = 30_V, .amplitude = 5_V, .angular_frequency = 4e5, .start = 2_us, .end = 50_us, .decay_time = 20_us};
  const Chirp endless{.base = 30_V, .amplitude = 5_V, .angular_frequency = 4e5, .start = 2_us, .decay_time = tau};
  const Chirp sweeping{.base = 0, .amplitude = 5_V, .angular_frequency = 4e5, .frequency_ratio = 3, .start = 0, .end = 50_us};
  const std::vector<Signal> inputs{signal(Pulse{.levels = {40_V, 3_V, 30_V}, .times = {20_us, 45_us}, .edge = 4_us}),
                                   signal(faded),
                                   signal(SCurve{.levels = {40_V, 20_V}, .times = {30_us}, .edge = 9_us}),
                                   signal(BSpline{.levels = {0, 40, 1, 7, 30}, .duration = 50_us}),
                                   signal(Sines{.base = 30_V, .amplitudes = {3, -5, 2}, .duration = 40_us}),
                                   signal(ended),
                                   signal(endless),
                                   signal(sweeping)};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Signal out = applied(inputs[i], of_time_constant(tau), limits, 1);
    // The trapezoidal rule has an error of 1e-6 V, and so have the cubics of sweeping pieces.
    for (const double t : {1e-6, 7e-6, 22e-6, 44e-6, 61e-6})
      EXPECT_NEAR(out.voltage(t), integrated(inputs[i], tau, t), 1e-5) << i << " at " << t;
    for (const double t : out.breakpoints())
      EXPECT_EQ(out.voltage_before(t), out.voltage(t)) << i << " at " << t << ": a filter lets no jump through";
  }
}

TEST(Driver, FiltersACurveThatOutlastsItsTransients) {
  constexpr double quick = 0.1e-6;  // decays long before the end of a piece
  const Signal curve = signal(BSpline{.levels = {0, 40, 1, 7, 30}, .duration = 50_us});
  const Signal out = applied(curve, of_time_constant(quick), limits, 1);
  EXPECT_GT(out.pieces().size(), curve.pieces().size());
  for (const double t : {6e-6, 13e-6, 24e-6, 31e-6, 49e-6}) EXPECT_NEAR(out.voltage(t), integrated(curve, quick, t), 1e-5) << t;
}

TEST(Driver, OfBandwidthAndResistanceHasTwoPoles) {
  // The step response of 1 / ((1 + a p) (1 + b p)) is 1 - (a exp(-t / a) - b exp(-t / b)) / (a - b), and for a = b 1 - (1 + t /
  // a) exp(-t / a).
  const double a = tau, b = 5e-6;
  const auto out = [&](double second) {
    DriverModel model = of_time_constant(a);
    model.load = 1e-12;
    model.source_resistance = second / model.load;
    return applied(Signal::constant(1_V), model, limits, 1);
  };
  for (const double t : {0.3e-6, 2e-6, 9e-6, 40e-6, 85e-6}) {
    EXPECT_NEAR(out(b).voltage(t), 1 - (a * std::exp(-t / a) - b * std::exp(-t / b)) / (a - b), kDriverRounding) << t;
    EXPECT_NEAR(out(a).voltage(t), 1 - (1 + t / a) * std::exp(-t / a), 1e-9) << t;
    EXPECT_NEAR(out(a * (1 + 1e-7)).voltage(t), 1 - (1 + t / a) * std::exp(-t / a), 1e-6) << t;
  }
}

TEST(Driver, HoldsEverySampleUntilTheNextOne) {
  const Signal commanded = signal(Step{.level = 40_V, .rise_time = 10_us});
  const Signal out = applied(commanded, {.sample_rate = 1e6}, limits, 1);
  for (double t = 0.05e-6; t < 15e-6; t += 0.1e-6) EXPECT_EQ(out.voltage(t), commanded.voltage(std::floor(t * 1e6) / 1e6)) << t;
  EXPECT_EQ(out.hold_level(), 40);
}

TEST(Driver, RoundsSamplesToHalfAStep) {
  const Signal commanded = signal(Harmonic{.base = 20_V, .amplitude = 17_V, .angular_frequency = 1e5, .end = 80_us});
  const Signal out = applied(commanded, {.sample_rate = 10e6, .bits = 6}, limits, 1);
  const double step = 60.0 / 63;
  double worst = 0;
  for (int k = 0; k < 900; ++k) {
    const double t = k / 10e6, volts = out.voltage(t), code = (volts + 10) / step;
    EXPECT_NEAR(code, std::round(code), 1e-9) << t;
    worst = std::max(worst, std::abs(volts - commanded.voltage(t)));
  }
  EXPECT_LE(worst, step / 2 * (1 + 1e-9));
  EXPECT_GT(worst, step / 3);
}

TEST(Driver, WithSamplesAndBitsIsIdempotent) {
  const DriverModel model{.sample_rate = 3e6, .bits = 8};
  const Signal commanded = signal(BSpline{.levels = {0, 40, 1, 7, 30}, .duration = 50_us});
  const Signal once = applied(commanded, model, limits, 1);
  EXPECT_EQ(applied(once, model, limits, 1).pieces(), once.pieces());
  EXPECT_GT(once.pieces().size(), 50U);
}

TEST(Driver, GoesFromSampleToSampleNoFasterThanItsSlewLimit) {
  DriverLimits slow = limits;
  slow.max_slew = 5e6;
  const Signal commanded = signal(Step{.level = 40_V, .rise_time = 10_us});  // 4 V/us
  const Signal out = applied(commanded, {.sample_rate = 1e6}, slow, 1);
  EXPECT_NEAR(out.peak_slew(), 5e6, 5e6 * 1e-9);
  EXPECT_NEAR(out.voltage(3.5e-6), 8 + 5 * 0.5, 40 * kDriverRounding);
  EXPECT_NEAR(out.voltage(3.9e-6), 12, 40 * kDriverRounding);
  // At the slew limit a jump takes several samples.
  const Signal jump = applied(Signal::constant(40_V), {.sample_rate = 1e6}, slow, 1);
  EXPECT_NEAR(jump.voltage(4e-6), 20, 40 * kDriverRounding);
  EXPECT_NEAR(jump.voltage(8e-6), 40, 40 * kDriverRounding);
  EXPECT_EQ(jump.hold_level(), 40);
  const Signal two = applied(signal(Pulse{.levels = {40_V, 10_V}, .times = {3_us}}), {.sample_rate = 1e6}, slow, 1);
  EXPECT_NEAR(two.voltage(2.9e-6), 14.5, 40 * kDriverRounding);
  EXPECT_NEAR(two.voltage(3.5e-6), 12.5, 40 * kDriverRounding);
  EXPECT_NEAR(two.voltage(4.1e-6), 10, 40 * kDriverRounding);
}

TEST(Driver, FollowsARampAsSteepAsItsSlewLimitLateByASample) {
  DriverLimits slow = limits;
  slow.max_slew = 5e6;
  const Signal out = applied(signal(Step{.level = 40_V, .rise_time = 8_us}), {.sample_rate = 1e6}, slow, 1);
  for (double t = 1.3e-6; t < 9e-6; t += 0.4e-6) EXPECT_NEAR(out.voltage(t), 5e6 * (t - 1e-6), 40 * kDriverRounding) << t;
}

TEST(Driver, FiltersHeldSamplesExactly) {
  const Signal commanded = signal(Step{.level = 40_V, .rise_time = 10_us});
  DriverModel model = of_time_constant(tau);
  model.sample_rate = 1e6;
  const Signal out = applied(commanded, model, limits, 1);
  double expected = 0;
  for (int k = 0; k < 10; ++k) {
    const double input = commanded.voltage(k / 1e6);
    expected = input + (expected - input) * std::exp(-1e-6 / tau);
    EXPECT_NEAR(out.voltage((k + 1) / 1e6), expected, 40 * kDriverRounding) << k;
  }
}

TEST(Driver, SamplesASineThatNeverEndsUpToTheEnd) {
  const Signal endless = signal(Harmonic{.base = 3_V, .amplitude = 2_V, .angular_frequency = 1e6});
  const Signal out = applied(endless, {.sample_rate = 10e6}, limits, 50_us);
  EXPECT_EQ(out.voltage(49.95_us), endless.voltage(499 / 10e6));
  EXPECT_EQ(out.hold_level(), 3);
  test::expect_invalid([&] { (void)applied(endless, {.sample_rate = 1e12}, limits, 1); },
                       {"has 1000000000000 samples", "it must have at most 10000000"});
}

TEST(Driver, AppliesTheCommandedVoltageBeforeItBegins) {
  const Signal stands = signal(Step{.level = 20_V}, 20_V), rises = signal(Step{.level = 40_V}, 20_V);
  const DriverModel sampled{.sample_rate = 1e6}, filtered = of_time_constant(tau), charging{.source_resistance = 1, .load = tau};
  const DriverModel all{.sample_rate = 1e6, .bits = 12, .bandwidth = filtered.bandwidth, .source_resistance = 1, .load = tau};
  for (const DriverModel& model : {sampled, filtered, charging, all}) {
    const Signal still = applied(stands, model, limits, 1), output = applied(rises, model, limits, 1);
    EXPECT_EQ(output.before(), 20_V);
    // Twelve bits round by 7 mV.
    for (const double time : {0.0, 1e-6, 1e-4}) EXPECT_NEAR(still.voltage(time), 20_V, 8e-3);
    EXPECT_NEAR(output.voltage(1), 40_V, 8e-3);
  }
  EXPECT_NEAR(applied(rises, filtered, limits, 1).voltage(tau), 40 - 20 * std::exp(-1), 1e-9);
  const DriverLimits slow{.min_voltage = -10, .max_voltage = 50, .max_slew = 1e6};
  EXPECT_NEAR(applied(rises, sampled, slow, 1).voltage(10e-6), 30_V, 1e-9) << "at 1 V/us from where it stood";
}

// The converter samples the commanded voltage. Gain, offset and delay act after the converter and before the filters.
TEST(Driver, AppliesItsErrorsAfterItsConverterAndBeforeItsFilters) {
  const Signal commanded = signal(Step{.level = 40_V, .rise_time = 10_us});
  DriverModel model = of_time_constant(tau);
  model.sample_rate = 1e6;
  model.bits = 4;
  const SourceErrors errors{.gain = 1.1, .offset = 0.5, .delay = 0.3e-6};
  const Signal samples = held(commanded, model, limits, 1);
  EXPECT_EQ(applied(commanded, model, limits, 1, errors).pieces(),
            internal::filtered(with_errors(samples, errors), 1 / (2 * std::numbers::pi * *model.bandwidth)).pieces());
  EXPECT_EQ(applied(commanded, model, limits, 1, {}).pieces(), applied(commanded, model, limits, 1).pieces());
  model.bandwidth.reset();
  EXPECT_GT(applied(Signal::constant(limits.max_voltage), model, limits, 1, errors).maximum(), limits.max_voltage)
      << "an amplifier gives more than is asked for";
  EXPECT_EQ(applied(Signal(), model, limits, 1, errors).hold_level(), 0.5) << "told nothing it gives its offset";
}

const std::vector<std::pair<const char*, Waveform>>& of_every_family() {
  static const std::vector<std::pair<const char*, Waveform>> all{
      {"step", Step{.level = 40_V}},
      {"ramp", Step{.level = 40_V, .rise_time = 3.3_us}},
      {"pulse", Pulse{.levels = {40_V, 3_V, 30_V}, .times = {20_us, 45_us}, .edge = 4_us}},
      {"harmonic", Harmonic{.base = 30_V, .amplitude = 5_V, .angular_frequency = 6e5, .start = 5_us, .end = 60_us, .fade = 9_us}},
      {"endless", Harmonic{.base = 30_V, .amplitude = 5_V, .angular_frequency = 6e5}},
      {"s-curve", SCurve{.levels = {40_V, 20_V}, .times = {30_us}, .edge = 9_us}},
      {"bspline", BSpline{.levels = {0, 40, 1, 7, 30}, .duration = 50_us}},
      {"sines", Sines{.base = 30_V, .amplitudes = {3, -5, 2}, .duration = 40_us}},
      {"chirp", Chirp{.base = 20_V, .amplitude = 5_V, .angular_frequency = 4e5, .start = 2_us, .decay_time = 9_us}},
      {"table", Table{.time = {0, 7e-6, 7e-6, 31e-6}, .voltage = {2, 40, 11, 13.7}}}};
  return all;
}

std::vector<DriverModel> converters() {
  DriverModel all = of_time_constant(tau);
  all.sample_rate = 7.3e6, all.bits = 12, all.source_resistance = 1, all.load = tau;
  return {{.sample_rate = 25e6}, {.sample_rate = 25e6, .bits = 14}, {.sample_rate = 1e6 / 3, .bits = 3}, all};
}

// A signal that is exported for a generator and read back has the same samples.
TEST(Driver, SamplesItsOwnSamplesToTheSameBits) {
  const double end = 100_us;
  for (const auto& [name, waveform] : of_every_family()) {
    int which = 0;
    for (const DriverModel& model : converters()) {
      SCOPED_TRACE(std::string(name) + ", source " + std::to_string(which++));
      const Signal commanded = signal(waveform), samples = commanded_samples(commanded, model, limits, end);
      const std::string file = csv({{"main", samples}}, end, {{"main", *model.sample_rate}});
      const Table again = parse_table(file, "again.csv", "main");
      for (std::size_t k = 0; k < again.time.size(); ++k) ASSERT_EQ(again.time[k], static_cast<double>(k) / *model.sample_rate);
      EXPECT_EQ(again.voltage.back(), samples.hold_level());
      const SourceErrors errors{.gain = 1.02, .offset = 0.1, .delay = 33e-9};
      for (const SourceErrors& own : {SourceErrors{}, errors}) {
        EXPECT_EQ(applied(signal(again), model, limits, end, own).pieces(), applied(commanded, model, limits, end, own).pieces());
      }
      if (!model.bits) continue;
      const std::string integers = codes({{"main",
                                           {.held = samples,
                                            .sample_rate = *model.sample_rate,
                                            .bits = *model.bits,
                                            .minimum = limits.min_voltage,
                                            .maximum = limits.max_voltage}}});
      std::istringstream in(integers);
      std::string head;
      std::getline(in, head);
      EXPECT_EQ(head, "index,main");
      const double most = std::exp2(*model.bits) - 1, step = (limits.max_voltage - limits.min_voltage) / most;
      std::size_t index = 0, row = 0;
      long code = 0;
      for (char comma = 0; in >> index >> comma >> code; ++row) {
        EXPECT_EQ(index, row);
        ASSERT_LT(row, again.voltage.size());
        EXPECT_GE(code, 0);
        EXPECT_LE(code, most);
        // The level before the beginning is not rounded.
        const bool stands = again.voltage[row] == 0 && (row == 0 || again.voltage[row - 1] == 0);
        EXPECT_NEAR(limits.min_voltage + step * static_cast<double>(code), again.voltage[row], stands ? step / 2 : 1e-12);
      }
      EXPECT_EQ(row, again.voltage.size());
    }
  }
}

// After rounding, the samples of the steepest permitted ramp are steeper by a step of the converter.
TEST(Driver, PermitsTheSamplesOfAPermittedSignal) {
  const DriverLimits slow{.min_voltage = -10, .max_voltage = 50, .max_slew = 20e6};
  const DriverModel coarse{.sample_rate = 25e6, .bits = 8};
  const Signal commanded = signal(Step{.level = 37_V, .rise_time = 37 / 20e6});
  ASSERT_EQ(violation(commanded, slow), "");
  const Signal samples =
      signal(parse_table(csv({{"main", commanded_samples(commanded, coarse, slow, 1e-5)}}, 1e-5, {{"main", 25e6}}), "x", "main"));
  EXPECT_NE(violation(samples, slow), "");
  EXPECT_EQ(violation(samples, limits_of_samples(slow, coarse)), "");
  EXPECT_EQ(limits_of_samples(slow, {.bandwidth = 1e6}).max_slew, slow.max_slew);
}

TEST(Codes, OfOneFileHaveOneRate) {
  const Coded one{.held = Signal::constant(1), .sample_rate = 1e6, .bits = 2, .minimum = 0, .maximum = 3};
  Coded other = one;
  other.sample_rate = 2e6;
  EXPECT_EQ(codes({{"a", one}, {"b", one}}), "index,a,b\n0,1,1\n");
  test::expect_invalid([&] { (void)codes({{"a", one}, {"b", other}}); }, {"2000000 Hz", "1000000 Hz", "the same rate"});
  test::expect_invalid([&] { (void)codes({}); }, {"at least one drive with samples"});
}

}  // namespace
}  // namespace softland
