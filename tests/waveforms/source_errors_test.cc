// Tests the effect of source errors on a signal.
#include "waveforms/source_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/waveforms/expect_invalid.h"
#include "waveforms/export.h"
#include "waveforms/waveform.h"

namespace softland::source_errors_test {
namespace {

constexpr double rounding = 1e-12;  // relative

const Pulse throw_and_catch{.levels = {20, 5, 17}, .times = {22e-6, 30e-6}, .edge = 1e-6};
const Harmonic dither{
    .base = 15, .amplitude = 1, .angular_frequency = 3e5, .phase = 0.4, .start = 10e-6, .end = 90e-6, .fade = 20e-6};
const Harmonic endless{.base = 15, .amplitude = 1, .angular_frequency = 3e5, .phase = 0.4, .start = 10e-6};
const Table corners{.time = {0, 10e-6, 20e-6, 40e-6}, .voltage = {0, 10, 4, 15}};

const std::vector<Waveform>& one_of_each() {
  static const std::vector<Waveform> all{Step{.level = 17}, dither, endless, throw_and_catch, corners};
  return all;
}

// Returns the signal as rows of a table.
Table rows(const Signal& signal) {
  Table table;
  for (const auto& [time, voltage] : polyline(signal, signal.pieces().back().begin, 0, 0)) {
    table.time.push_back(time);
    table.voltage.push_back(voltage);
  }
  return table;
}

TEST(SourceErrors, OfNothingLeaveTheBits) {
  for (const Waveform& waveform : one_of_each()) {
    const Signal given = signal(waveform);
    EXPECT_EQ(with_errors(given, {}).pieces(), given.pieces()) << family(waveform);
    EXPECT_EQ(with_errors(given, {.edges = std::vector<double>(edge_count(given), 0.0)}).pieces(), given.pieces())
        << family(waveform);
  }
}

TEST(SourceErrors, OfNothingLeaveTheBitsOfRampsThatEndInAJump) {
  for (int i = 1; i <= 300; ++i) {
    const double jump = i * 1e-7 / 3;
    const Signal given = signal(Table{.time = {0, jump, jump, 2e-4}, .voltage = {i / 7.0, i / 3.0, 1, 0.3 * i}});
    EXPECT_EQ(with_errors(given, {}).pieces(), given.pieces()) << i;
  }
}

TEST(SourceErrors, ADelayIsATableOfLaterRows) {
  constexpr double delay = 50e-9;
  Table late = rows(signal(throw_and_catch));
  for (double& time : late.time) time += delay;
  late.time.insert(late.time.begin(), 0);
  late.voltage.insert(late.voltage.begin(), 0);
  EXPECT_EQ(with_errors(signal(throw_and_catch), {.delay = delay}).pieces(), signal(late).pieces());
}

TEST(SourceErrors, ADelayMakesEverySignalTheSameButLater) {
  constexpr double delay = 3.7e-6, offset = 0.05;
  for (const Waveform& waveform : one_of_each()) {
    const Signal given = signal(waveform), late = with_errors(given, {.offset = offset, .delay = delay});
    for (double t = 0.0131e-6; t < 120e-6; t += 0.173e-6)
      EXPECT_NEAR(late.voltage(t), given.voltage(t - delay) + offset, 100 * rounding) << family(waveform) << " at " << t;
    EXPECT_EQ(late.voltage(0), offset) << "from t = 0 on";
    EXPECT_EQ(late.voltage_before(0), 0) << "and not before";
    EXPECT_DOUBLE_EQ(late.hold_level(), given.hold_level() + offset);
  }
}

TEST(SourceErrors, EarlySignalsLoseNothingWhereTheClockBeginsAtTheirFirstEdge) {
  for (const Waveform& waveform : one_of_each()) {
    const Signal given = signal(waveform);
    EXPECT_EQ(first_edge(given, {.delay = -2e-6}), -2e-6);
    const Signal early = with_errors(given, {.delay = -2e-6}, -2e-6);
    ASSERT_EQ(early.pieces().size(), given.pieces().size());
    for (double t = 0; t < 120e-6; t += 0.173e-6)
      EXPECT_NEAR(early.voltage(t), given.voltage(t), 1e-9) << family(waveform) << " at " << t;
  }
  // Another drive of that device, without an error, is later on the same clock.
  const Signal in_time = with_errors(signal(throw_and_catch), {}, -2e-6);
  EXPECT_DOUBLE_EQ(in_time.pieces()[3].begin, 24e-6);
}

TEST(SourceErrors, AJumpARampAndACornerAreEdges) {
  EXPECT_EQ(edge_count(signal(Step{.level = 17})), 1U);
  EXPECT_EQ(edge_count(signal(Step{.level = 17, .rise_time = 1e-6})), 1U);
  EXPECT_EQ(edge_count(signal(throw_and_catch)), 3U);
  EXPECT_EQ(edge_count(signal(corners)), 4U);
  EXPECT_EQ(edge_count(signal(Pulse{.levels = {0, 5}, .times = {10e-6}})), 1U) << "0 V at t = 0 is no edge";
  EXPECT_EQ(with_errors(signal(Pulse{.levels = {0, 5}, .times = {10e-6}}), {.delay = 1e-6}).pieces().size(), 2U);
  EXPECT_EQ(edge_count(Signal()), 0U);
  EXPECT_EQ(edge_count(signal(dither)), 3U) << "the base, and both fades as a whole";
  EXPECT_EQ(first_edge(Signal(), {.delay = -1}), std::numeric_limits<double>::infinity());
}

TEST(SourceErrors, EveryEdgeMovesByATimeOfItsOwn) {
  const Signal given = signal(throw_and_catch);
  const Signal moved = with_errors(given, {.edges = {0.1e-6, -0.2e-6, 0.3e-6}});
  // The edges are from 0 V on [0.1, 1.1], to 5 V on [21.8, 22.8], to 17 V on [30.3, 31.3] us.
  const std::vector<std::pair<double, double>> points{{0, 0},       {0.1e-6, 0},  {1.1e-6, 20}, {21.8e-6, 20},
                                                      {22.8e-6, 5}, {30.3e-6, 5}, {31.3e-6, 17}};
  const Signal expected = Signal::piecewise_linear(points);
  ASSERT_EQ(moved.pieces().size(), expected.pieces().size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(moved.pieces()[i].begin, expected.pieces()[i].begin, rounding * 1e-6) << i;
    EXPECT_EQ(moved.pieces()[i].value, expected.pieces()[i].value) << i;
    EXPECT_NEAR(moved.pieces()[i].slope, expected.pieces()[i].slope, 1e-9 * 2e7) << i;
  }
  EXPECT_DOUBLE_EQ(first_edge(given, {.delay = -3e-6, .edges = {1e-6}}), -2e-6);
  EXPECT_DOUBLE_EQ(with_errors(given, {.delay = 3e-6, .edges = {-1e-6}}).pieces()[1].begin, 2e-6) << "a delay beside it";
  // Corners move separately, and keep their voltages.
  const Signal bent = with_errors(signal(corners), {.edges = {0, 1e-6, -1e-6}});
  EXPECT_NEAR(bent.voltage(11e-6), 10, 1e-9);
  EXPECT_NEAR(bent.voltage(19e-6), 4, 1e-9);
  EXPECT_NEAR(bent.voltage(15e-6), 7, 1e-9);
}

TEST(SourceErrors, EdgesKeepTheirOrder) {
  const Signal given = signal(Pulse{.levels = {20, 5, 17, 0, 3}, .times = {22e-6, 22.1e-6, 30e-6, 31e-6}});
  constexpr double wild = 1e-5;
  for (int pattern = 0; pattern < 32; ++pattern) {
    SourceErrors errors;
    for (int j = 0; j < 5; ++j) errors.edges.push_back(((pattern >> j) & 1) != 0 ? wild : -wild);
    const Signal moved = with_errors(given, errors, std::min(0.0, first_edge(given, errors)));
    const double origin = std::min(0.0, first_edge(given, errors));
    std::vector<double> levels;
    for (const SignalPiece& piece : moved.pieces()) levels.push_back(piece.value);
    if (errors.edges[0] > 0) levels.erase(levels.begin());  // the 0 V before a late first edge
    EXPECT_EQ(levels, (std::vector<double>{20, 5, 17, 0, 3})) << pattern;
    // Each edge moves by at most half of the time to its neighbours, in either direction.
    for (std::size_t j = 1; j < 4; ++j) {
      const std::size_t at = j + (errors.edges[0] > 0 ? 1 : 0);
      const double by = moved.pieces()[at].begin + origin - given.pieces()[j].begin;
      const double gap =
          by > 0 ? given.pieces()[j + 1].begin - given.pieces()[j].begin : given.pieces()[j].begin - given.pieces()[j - 1].begin;
      EXPECT_NEAR(std::abs(by), std::min(wild, 0.49 * gap), 1e-9 * wild) << pattern << " edge " << j;
    }
  }
}

TEST(SourceErrors, ACarrierKeepsItsPhaseWhereItsEndsMove) {
  const Signal given = signal(dither);
  const Signal moved = with_errors(given, {.edges = {0, 2e-6, -3e-6}});
  // Between the fades the sine is bit for bit the same; a fade is only shifted.
  for (double t = 35e-6; t < 65e-6; t += 1.3e-6) EXPECT_EQ(moved.voltage(t), given.voltage(t)) << t;
  EXPECT_EQ(moved.voltage(11e-6), 15) << "not yet";
  EXPECT_EQ(moved.voltage(88e-6), 15) << "over";
  const auto envelope = [](const Signal& s, double t) {
    const SignalPiece& p = s.pieces()[s.piece_at(t)];
    return p.amplitude + p.amplitude_slope * (t - p.begin);
  };
  EXPECT_NEAR(envelope(moved, 22e-6), 0.5, 1e-9);
  EXPECT_NEAR(envelope(moved, 77e-6), 0.5, 1e-9);
  // The corner at which two fades meet is an edge, at which both fades still meet.
  Harmonic tent = dither;
  tent.fade = 40e-6;
  const Signal leaning = with_errors(signal(tent), {.edges = {0, 0, 4e-6}});
  EXPECT_NEAR(envelope(leaning, 32e-6), 0.5, 1e-9);
  EXPECT_NEAR(envelope(leaning, 72e-6), 0.5, 1e-9);
}

TEST(SourceErrors, AreFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  test::expect_invalid([&] { (void)with_errors(signal(throw_and_catch), {.delay = nan}); }, {"finite"});
  test::expect_invalid([&] { (void)with_errors(signal(throw_and_catch), {.edges = {0, nan}}); }, {"finite"});
}

TEST(SourceErrors, SurviveDelaysThatSwallowAnEdge) {
  // 1 fs after ten minutes is below rounding: the ramp becomes a jump.
  const Signal given = signal(Pulse{.levels = {20, 5}, .times = {1e-6}, .edge = 1e-15});
  const Signal late = with_errors(given, {.delay = 600});
  EXPECT_EQ(late.hold_level(), 5);
  EXPECT_EQ(late.voltage(599), 0);
  EXPECT_TRUE(std::isfinite(late.pieces()[1].slope));
}

TEST(SourceErrors, ADelayProlongsWhatTheDriveHasStoodAt) {
  constexpr double delay = 50e-9, before = 6;
  const Signal given = signal(throw_and_catch, before), late = with_errors(given, {.offset = 0.5, .delay = delay});
  EXPECT_EQ(late.before(), before) << "errors act from t = 0 on";
  EXPECT_EQ(late.voltage(0.9 * delay), before + 0.5);
  for (const double time : {0.2e-6, 10e-6, 25e-6, 60e-6})
    EXPECT_NEAR(late.voltage(time + delay), given.voltage(time) + 0.5, 1e-6) << time;
  EXPECT_EQ(edge_count(signal(Step{.level = before}, before)), 0U);
}

// V(t) = gain f(t - delay) + offset from t = 0 on; the voltage before t = 0 is unchanged.
TEST(SourceErrors, OfGainOffsetAndDelayAreThatFormula) {
  for (const Waveform& waveform : one_of_each()) {
    const Signal given = signal(waveform, 2);
    const SourceErrors errors{.gain = 1.02, .offset = -0.3, .delay = 70e-9};
    const Signal own = with_errors(given, errors);
    EXPECT_EQ(own.before(), 2) << family(waveform);
    for (double t = 1e-9; t < 60e-6; t += 0.37e-6) {
      const double late = t - errors.delay, told = late < 0 ? 2 : given.voltage(late);
      EXPECT_NEAR(own.voltage(t), errors.gain * told + errors.offset, 1e-9) << family(waveform) << " at " << t;
    }
    EXPECT_DOUBLE_EQ(own.hold_level(), 1.02 * given.hold_level() - 0.3);
  }
}

TEST(SourceErrors, HaveAGainAboveZero) {
  for (const double gain : {0.0, -1.0, std::numeric_limits<double>::infinity()})
    EXPECT_THROW(static_cast<void>(with_errors(signal(corners), {.gain = gain})), InvalidInput) << gain;
}

}  // namespace
}  // namespace softland::source_errors_test
