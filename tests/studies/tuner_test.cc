// Tunes simulated devices that the belief has not seen, from the first closing on.
#include "studies/inverse/tuner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "sampling/statistics.h"
#include "studies/inverse/practice_device.h"
#include "studies/inverse/tuning_model.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

TunerOptions cheap(int jobs = 1) { return {.jobs = jobs, .effort = 0.02}; }

double last_breakpoint_of(const std::vector<Waveform>& waveforms) {
  double last = 0;
  for (const Waveform& waveform : waveforms) last = std::max(last, signal(waveform).breakpoints().back());
  return last;
}

PracticeClosing fired(const PracticeDevice& device, const TunerShot& shot, std::uint64_t number) {
  return device.close(number, shot.waveforms, last_breakpoint_of(shot.waveforms) + shot.hold_time);
}

std::vector<std::uint64_t> bits(const std::vector<Waveform>& waveforms) {
  std::vector<std::uint64_t> all;
  for (const Waveform& waveform : waveforms) {
    const Signal told = signal(waveform);
    for (const SignalPiece& piece : told.pieces()) {
      all.push_back(std::bit_cast<std::uint64_t>(piece.begin));
      all.push_back(std::bit_cast<std::uint64_t>(piece.value));
    }
  }
  return all;
}

std::vector<std::uint64_t> bits(const TunerShot& shot) {
  std::vector<std::uint64_t> all = bits(shot.waveforms);
  all.push_back(std::bit_cast<std::uint64_t>(shot.expected_cost));
  all.push_back(std::bit_cast<std::uint64_t>(shot.predicted.touch_median));
  return all;
}

void expect_within_limits(const Tuner& tuner, const std::vector<Waveform>& waveforms) {
  const PreparedScene& p = tuner.scene();
  for (std::size_t k = 0; k < waveforms.size(); ++k)
    EXPECT_EQ(violation(signal(waveforms[k]), p.limits(k)), "") << tuner.closings();
}

TEST(Tuners, ALogThatIsLearnedAgainGivesTheSameBitsWithAnyJobs_optimized) {
  const PracticeDevice device(gold_with_two_modes(), {.seed = 5});
  Tuner tuner(gold_with_two_modes(), cheap(1));
  std::vector<ContactRecord> log;
  std::vector<std::vector<std::uint64_t>> proposed{bits(tuner.next())};
  for (int k = 1; k <= 3; ++k) {
    log.push_back(fired(device, tuner.next(), static_cast<std::uint64_t>(k)).record);
    tuner.learn(log.back());
    proposed.push_back(bits(tuner.next()));
    expect_within_limits(tuner, tuner.next().waveforms);
  }
  Tuner again(gold_with_two_modes(), cheap(2));
  EXPECT_EQ(bits(again.next()), proposed[0]);
  for (std::size_t k = 0; k < log.size(); ++k) {
    again.learn(log[k]);
    EXPECT_EQ(bits(again.next()), proposed[k + 1]) << k;
  }
  EXPECT_EQ(bits(again.kept()), bits(tuner.kept()));
  Tuner restarted = again.restarted();
  EXPECT_EQ(restarted.closings(), 0);
  EXPECT_EQ(bits(restarted.next()), proposed[0]);
}

TEST(Tuners, RecipesThatAreKnownAreNotSearchedAgain_optimized) {
  const Tuner searched(gold_with_two_modes(), cheap());
  TunerOptions options = cheap();
  options.recipes = searched.recipes();
  ASSERT_EQ(options.recipes.size(), 1U);
  EXPECT_EQ(bits(Tuner(gold_with_two_modes(), options).next()), bits(searched.next()));
  constexpr double longer = 1.1;
  options.recipes[0].x[1] *= longer;
  EXPECT_NE(bits(Tuner(gold_with_two_modes(), options).next()), bits(searched.next()));
  options.recipes[0].x.pop_back();
  EXPECT_THROW(Tuner(gold_with_two_modes(), options), InvalidInput);
  options.recipes = {searched.recipes()[0], searched.recipes()[0]};
  EXPECT_THROW(Tuner(gold_with_two_modes(), options), InvalidInput);
  options.recipes = {searched.recipes()[0]};
  options.recipes[0].x[0] = std::nan("");
  EXPECT_THROW(Tuner(gold_with_two_modes(), options), InvalidInput);
}

// With drifting sources earlier voltages become wrong: the last shot that landed is kept.
TEST(Tuners, OfShotsThatAreRepeatedTheLastIsKept_optimized) {
  constexpr double drift = 1e-5;  // relative drift of the voltages from shot to shot
  const PracticeDevice device(gold_with_two_modes(), {.seed = 5, .drift = drift});
  Tuner tuner(gold_with_two_modes(), {.effort = 0.2});
  std::vector<Waveform> fired_last;
  for (int k = 1; k <= 30 && !tuner.is_done(); ++k) {
    fired_last = tuner.next().waveforms;
    tuner.learn(fired(device, tuner.next(), static_cast<std::uint64_t>(k)).record);
  }
  ASSERT_TRUE(tuner.is_done());
  EXPECT_EQ(bits(tuner.kept().waveforms), bits(fired_last));
  EXPECT_EQ(tuner.kept().number, tuner.next().number - 1);
}

TEST(Tuners, ARecordWithAnErrorLeavesTheBeliefUnchanged_optimized) {
  Tuner tuner(gold_with_two_modes(), cheap());
  const std::vector<std::uint64_t> first = bits(tuner.next());
  EXPECT_THROW(tuner.learn({.closing_time = -1}), InvalidInput);
  EXPECT_EQ(tuner.next().number, 1);
  tuner.learn({.error = "no trigger"});
  EXPECT_EQ(tuner.next().number, 2);
  EXPECT_EQ(tuner.closings(), 0);
  EXPECT_EQ(bits(tuner.next()), first);
}

TEST(Tuners, AClosingNarrowsTheBelief_optimized) {
  const PracticeDevice device(gold_with_two_modes(), {.seed = 6});
  Tuner tuner(gold_with_two_modes(), cheap());
  const auto find = [&](const char* name) {
    for (const BelievedQuantity& one : tuner.belief().quantities) {
      if (one.name == name) return one;
    }
    return BelievedQuantity{};
  };
  EXPECT_NEAR(find("structure.thickness").prior_deviation, 0.02, 1e-9);
  tuner.learn(fired(device, tuner.next(), 1).record);
  EXPECT_LT(find("gaps").deviation, 0.9 * find("gaps").prior_deviation);
}

TEST(Tuners, AtNoLevelMoreThanOneDeviceInAThousandCollapses_optimized) {
  const SceneFile file = gold({"structure.modes=2", "contact.effective_modulus=0.01 GPa", "driver.main.max_voltage=60 V"});
  const TuningModel scene(file, cheap(), {});
  const double safe = scene.safe_level(NormalBelief::standard(scene.size()));
  ASSERT_LT(safe, scene.nominal().limits(0).max_voltage);
  const Tuner tuner(file, cheap());
  constexpr double rounding = 1e-12;
  EXPECT_LE(signal(tuner.next().waveforms[0]).peak(), safe * (1 + rounding));
}

TEST(Tuners, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(Tuner(gold_with_two_modes(), {.laboratory = {.edge_error = 0}}), InvalidInput);
  EXPECT_THROW(Tuner(gold_with_two_modes(), {.laboratory = {.edge_error = 5e-6}}), InvalidInput);
  EXPECT_THROW(Tuner(gold_with_two_modes(), {.laboratory = {.shot_error = -1}}), InvalidInput);
  EXPECT_THROW(Tuner(gold_with_two_modes(), {.effort = 0}), InvalidInput);
  EXPECT_THROW(Tuner(gold_with_two_modes(), {.actuator = Actuator::pzt}), InvalidInput);
}

// A rare device may also explain one such touch: two records are needed.
TEST(Tuners, ADeviceThatDoesNotMatchTheModelIsReported_optimized) {
  constexpr int closings = 2;
  const Tuner fresh(gold_with_two_modes(), cheap());
  const auto tuned = [&](const PracticeModel& model) {
    const PracticeDevice device(gold_with_two_modes(), {.seed = 8, .model = model});
    Tuner tuner = fresh.restarted();
    for (std::uint64_t k = 1; k <= closings; ++k) tuner.learn(fired(device, tuner.next(), k).record);
    return tuner;
  };
  const Tuner soft = tuned({.set = {"structure.youngs_modulus=30 GPa"}});
  const TouchMisfit misfit = soft.belief().touch_misfit;
  ASSERT_TRUE(soft.broken_assumption()) << misfit.least << " of " << misfit.bound;
  EXPECT_TRUE(misfit.is_beyond());
  EXPECT_THAT(*soft.broken_assumption(), testing::HasSubstr("does not match the model"));
  EXPECT_FALSE(tuned({}).broken_assumption());
}

// A device of the spread is not rejected, wherever it is in the spread, and however many peaks its records leave in the belief.
TEST(Tuners, DevicesInTheTailOfTheSpreadAreNotRejected_optimized) {
  const Tuner fresh(gold_with_two_modes(), cheap());
  SceneFile alike = gold_with_two_modes();
  for (const char* cov : {"spread.\"structure.thickness\".cov=\"0.01 %\"", "spread.\"structure.youngs_modulus\".cov=\"0.01 %\"",
                          "spread.gaps.cov=\"0.01 %\""})
    alike.set(cov);
  // Three deviations of the thickness and of the gaps, to either side, and of the modulus.
  const std::vector<std::vector<std::string>> tails{
      {"structure.thickness=2.12 um"},
      {"structure.thickness=1.88 um"},
      {"gap.electrode=3.71 um", "gap.contact=2.12 um"},
      {"structure.thickness=2.06 um", "structure.youngs_modulus=83 GPa", "gap.electrode=3.57 um", "gap.contact=2.04 um"}};
  for (const std::vector<std::string>& tail : tails) {
    const PracticeDevice device(alike, {.seed = 3, .model = {.set = tail}});
    Tuner tuner = fresh.restarted();
    for (std::uint64_t k = 1; k <= 2; ++k) {
      tuner.learn(fired(device, tuner.next(), k).record);
      EXPECT_FALSE(tuner.broken_assumption()) << tail.front() << " " << k << " " << tuner.broken_assumption().value_or("");
    }
  }
}

// A trigger with a delay of 1 us. Without the delay as an unknown the device would be learned as one with other gaps.
TEST(Tuners, ALateTriggerIsNoOtherDevice_slow) {
  constexpr int devices = 3, closings = 4;
  constexpr double late = 1e-6, soft = 10e-9, few_percent = 0.05;
  const Tuner fresh(gold_with_two_modes(), {.jobs = 2, .effort = 0.3});
  for (int n = 0; n < devices; ++n) {
    const PracticeDevice device(gold_with_two_modes(), {.seed = 51 + static_cast<std::uint64_t>(n), .trigger_delay = late});
    Tuner tuner = fresh.restarted();
    for (std::uint64_t k = 1; k <= closings; ++k) tuner.learn(fired(device, tuner.next(), k).record);
    EXPECT_FALSE(tuner.broken_assumption()) << n << " " << tuner.broken_assumption().value_or("");
    EXPECT_FALSE(!(fired(device, tuner.kept(), 100).motion.major_bounce_height <= soft)) << n;
    EXPECT_FALSE(!(std::abs(tuner.belief().gap_ratio->mean - 1) <= few_percent)) << n;
  }
}

// A waveform that landed some closings ago may bounce after a drift. It is fired again, and the new record decides.
TEST(Tuners, TheWaveformKeptIsFiredAgainAndCountsAsItLandsThen_optimized) {
  constexpr int most = 8;
  const PracticeDevice device(gold_with_two_modes(), {.seed = 5});
  Tuner tuner(gold_with_two_modes(), {.effort = 0.1});
  const std::vector<std::uint64_t> first = bits(tuner.next().waveforms);
  tuner.fire_kept_again();
  EXPECT_EQ(bits(tuner.next().waveforms), first) << "nothing was fired before";
  const auto keeps_one_that_was_fired = [&] { return tuner.closings() > 0 && tuner.kept().number < tuner.next().number; };
  while (!keeps_one_that_was_fired() && tuner.closings() < most)
    tuner.learn(fired(device, tuner.next(), static_cast<std::uint64_t>(tuner.closings()) + 1).record);
  ASSERT_TRUE(keeps_one_that_was_fired());
  const std::vector<std::uint64_t> kept = bits(tuner.kept().waveforms);
  const int before = tuner.closings();
  tuner.fire_kept_again();
  ASSERT_EQ(bits(tuner.next().waveforms), kept);
  ContactRecord bounced = fired(device, tuner.next(), 100).record;
  const double touch = *first_touch(bounced);
  bounced.edges = {{.time = touch, .closed = true}, {.time = touch + 2e-6}, {.time = touch + 9e-6, .closed = true}};
  tuner.learn(bounced);
  EXPECT_EQ(tuner.closings(), before + 1);
  EXPECT_NE(bits(tuner.kept().waveforms), kept) << "it bounced when it was fired last";
  EXPECT_FALSE(tuner.was_kept_last());
}

// The ratio of the gaps is a quantity of the belief, so that the belief predicts such records and lands the device. It must
// still report the ratio.
TEST(Tuners, GapsOfAnotherRatioThanTheSceneAreFound_slow) {
  constexpr int closings = 4, devices = 4;
  const Tuner fresh(gold_with_two_modes(), {.jobs = 2, .effort = 0.3});
  const auto tuned = [&](const PracticeDevice& device) {
    Tuner tuner = fresh.restarted();
    for (std::uint64_t k = 1; k <= closings; ++k) tuner.learn(fired(device, tuner.next(), k).record);
    return tuner;
  };
  int found = 0;
  for (std::uint64_t seed = 11; seed < 11 + devices; ++seed) {
    const Tuner wide = tuned(PracticeDevice(gold_with_two_modes(), {.seed = seed, .model = {.set = {"gap.contact=2.16 um"}}}));
    ASSERT_TRUE(wide.belief().gap_ratio);
    if (wide.broken_assumption()) {
      ++found;
      EXPECT_THAT(*wide.broken_assumption(),
                  testing::AllOf(testing::HasSubstr("its contact gap is"), testing::HasSubstr("wider")));
    }
    EXPECT_FALSE(tuned(PracticeDevice(gold_with_two_modes(), {.seed = seed})).broken_assumption()) << seed;
  }
  EXPECT_GE(found, 1) << "of the searches of little effort here, and of most others";
}

TEST(Tuners, AnEarlierTouchIsFoundWhereItIsAskedFor_optimized) {
  TunerOptions options{.effort = 0.1};
  const Tuner usual(gold_with_two_modes(), options);
  options.touch = parse_condition("initial_contact_time < 0.88 step", all_figures);
  const Tuner bound(gold_with_two_modes(), options);
  constexpr double clearly = 0.985;
  EXPECT_LT(bound.next().predicted.touch_median, clearly * usual.next().predicted.touch_median);
  for (const char* other : {"initial_contact_time > 20 us", "impact_velocity < 1 mm/s"}) {
    options.touch = parse_condition(other, all_figures);
    EXPECT_THROW(Tuner(gold_with_two_modes(), options), InvalidInput) << other;
  }
}

TunerOptions by_piezo() {
  TunerOptions options = cheap();
  options.actuator = Actuator::pzt;
  return options;
}

SceneFile gold_pzt_with_two_modes() { return gold_pzt({"structure.modes=2"}); }

TEST(Tuners, ASwitchThatAPiezoCanCarryIsLandedSlowlyFromTheFirstShotOn_optimized) {
  constexpr double few_nanometres = 60e-9, latest = 1.05;
  Tuner tuner(gold_pzt_with_two_modes(), by_piezo());
  ASSERT_EQ(tuner.approach(), Approach::quasi_static);
  const PracticeDevice device(gold_pzt_with_two_modes(), {.seed = 5});
  for (int k = 1; k <= 3; ++k) {
    expect_within_limits(tuner, tuner.next().waveforms);
    EXPECT_LT(tuner.next().predicted.touch_median, latest * tuner.step_permanent_contact()) << k;
    const PracticeClosing closing = fired(device, tuner.next(), static_cast<std::uint64_t>(k));
    EXPECT_LT(closing.motion.major_bounce_height, few_nanometres) << k;
    tuner.learn(closing.record);
  }
}

TEST(Tuners, ARequestedEarlyTouchIsReached_optimized) {
  TunerOptions options = by_piezo();
  options.actuator = Actuator::both;
  EXPECT_EQ(Tuner(gold_pzt_with_two_modes(), options).approach(), Approach::quasi_static);
  options.touch = parse_condition("initial_contact_time < 1.5 step", all_figures);
  EXPECT_EQ(Tuner(gold_pzt_with_two_modes(), options).approach(), Approach::fast);
}

TEST(Tuners, RecipesKeepTheirApproach_optimized) {
  const Tuner searched(gold_pzt_with_two_modes(), by_piezo());
  TunerOptions options = by_piezo();
  options.recipes = searched.recipes();
  EXPECT_EQ(bits(Tuner(gold_pzt_with_two_modes(), options).next()), bits(searched.next()));
  options.recipes[0].approach = Approach::fast;
  EXPECT_THROW(Tuner(gold_pzt_with_two_modes(), options), InvalidInput) << "they have another number of parameters";
  options.recipes[0].approach = Approach::quasi_static;
  options.actuator = Actuator::electrostatic;
  EXPECT_THROW(Tuner(gold_pzt_with_two_modes(), options), InvalidInput) << "its contact lies beyond the fold";
}

// A rare device may stay open once; twice is unexpected.
TEST(Tuners, ContactsThatTwiceStayOpenAreUnexpected_optimized) {
  Tuner tuner(gold_with_two_modes(), cheap());
  ASSERT_GT(tuner.next().predicted.touches, 0.97);
  tuner.learn({});
  EXPECT_FALSE(tuner.broken_assumption());
  EXPECT_EQ(tuner.surprises(), std::vector<double>{0});
  tuner.learn({});
  ASSERT_TRUE(tuner.broken_assumption());
  EXPECT_THAT(*tuner.broken_assumption(), testing::HasSubstr("no device of the spread touches as recorded"));
}

// Devices of a wafer that is 4 % too thick, with variations of 0.1 %. Counts closings up to the second of two bounce-free ones
// in a row.
TEST(Tuners, LaterDevicesOfAWaferNeedFewerClosings_slow) {
  SceneFile wafer = gold_with_two_modes();
  wafer.set("structure.thickness=2.08 um");
  for (const char* cov : {"spread.\"structure.thickness\".cov=\"0.1 %\"", "spread.\"structure.youngs_modulus\".cov=\"0.1 %\"",
                          "spread.gaps.cov=\"0.1 %\""})
    wafer.set(cov);
  const TunerOptions usual{.jobs = 2, .effort = 0.2};
  struct Tuned {
    TunedBelief belief;
    int closings = 0;
    double first_rebound = 0;  // rebound of the first shot [m]
  };
  const auto tuned = [&](const TunerOptions& options, std::uint64_t seed) {
    constexpr int most = 8;
    const PracticeDevice device(wafer,
                                {.seed = seed, .laboratory = {.gain_error = 0}});  // the laboratory is the same for all devices
    Tuner tuner(gold_with_two_modes(), options);
    Tuned one;
    while (tuner.closings() < most && tuner.bounce_free_in_a_row() < 2) {
      const PracticeClosing closing = fired(device, tuner.next(), static_cast<std::uint64_t>(tuner.closings()) + 1);
      if (tuner.closings() == 0) one.first_rebound = closing.motion.major_bounce_height;
      expect_within_limits(tuner, tuner.next().waveforms);
      tuner.learn(closing.record);
    }
    one.belief = tuner.belief().coordinates;
    one.closings = tuner.closings();
    return one;
  };
  TunerOptions later = usual;
  later.wafer.push_back(tuned(usual, 41).belief);
  int alone = 0, together = 0;
  for (const std::uint64_t seed : {42U, 43U, 44U}) {
    const Tuned one = tuned(usual, seed), next = tuned(later, seed);
    alone += one.closings;
    together += next.closings;
    EXPECT_LT(next.first_rebound, one.first_rebound) << seed;
    later.wafer.push_back(next.belief);
  }
  EXPECT_LT(together, alone);
}

// The complete procedure: gold cantilevers with one mode more than the belief has rebound below 10 nm within three closings.
TEST(Tuners, DevicesThatNoBeliefHasSeenLandWithinThreeClosings_slow) {
  const Tuner fresh(gold(), {.jobs = 2, .effort = 0.5});
  constexpr int devices = 4, closings = 3, shots = 10;
  for (int n = 0; n < devices; ++n) {
    const PracticeDevice device(gold(), {.seed = 31 + static_cast<std::uint64_t>(n), .model = {.more_modes = 1}});
    Tuner tuner = fresh.restarted();
    for (int k = 1; k <= closings; ++k) {
      expect_within_limits(tuner, tuner.next().waveforms);
      tuner.learn(fired(device, tuner.next(), static_cast<std::uint64_t>(k)).record);
    }
    std::vector<double> heights;
    for (int k = 0; k < shots; ++k)
      heights.push_back(fired(device, tuner.kept(), 100 + static_cast<std::uint64_t>(k)).motion.major_bounce_height);
    constexpr double soft = 10e-9;
    EXPECT_FALSE(!(sample_quantile(heights, 0.95) <= soft)) << n;
    EXPECT_FALSE(tuner.broken_assumption()) << *tuner.broken_assumption();
  }
}

TEST(Tuners, RepeatedShotsFollowADrift_slow) {
  constexpr double drift = 1e-5;  // relative drift of all voltages from closing to closing
  constexpr int first = 20, last = 100;
  Tuner tuner(gold(), {.jobs = 2});
  const PracticeDevice device(gold(), {.seed = 4001, .drift = drift, .model = {.more_modes = 1}});
  double volts = 0;
  for (int k = 1; k <= last; ++k) {
    if (k == first) volts = signal(tuner.next().waveforms[0]).peak();
    expect_within_limits(tuner, tuner.next().waveforms);
    tuner.learn(fired(device, tuner.next(), static_cast<std::uint64_t>(k)).record);
  }
  EXPECT_TRUE(tuner.is_done());
  const double followed = signal(tuner.next().waveforms[0]).peak() / volts, due = (1 + drift * first) / (1 + drift * last);
  constexpr double scatter = 4e-4;  // scatter of touch times, and lag of the control
  EXPECT_FALSE(!(std::abs(followed - due) <= scatter)) << followed << " " << due;

  const std::size_t before = tuner.surprises().size();
  const auto learn_with_opening = [&](double seconds) {
    ContactRecord record = fired(device, tuner.next(), static_cast<std::uint64_t>(tuner.next().number)).record;
    const double touch = *first_touch(record);
    record.edges = {{.time = touch, .closed = true}, {.time = 1.1 * touch}, {.time = 1.1 * touch + seconds, .closed = true}};
    tuner.learn(record);
  };
  learn_with_opening(0.5e-6);
  EXPECT_EQ(tuner.surprises().size(), before) << "a bounce by less than a nanometre ended the steering";
  learn_with_opening(5e-6);
  EXPECT_EQ(tuner.surprises().size(), before + 1);
}

}  // namespace
}  // namespace softland
