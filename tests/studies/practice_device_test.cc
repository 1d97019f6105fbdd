#include "studies/inverse/practice_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "studies/closing/simulate.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double window = 100e-6;  // [s]

PracticeOptions exact_instruments() { return {.laboratory = {.edge_error = 0, .unseen = 0, .gain_error = 0, .shot_error = 0}}; }

const std::vector<Waveform>& plain_step() {
  static const std::vector<Waveform> drives{Step{.level = 17.771}};
  return drives;
}

TEST(PracticeDevice, MovesAsTheSwitchOfItsOwnScene) {
  const PracticeDevice device(gold_at_17_volts(), exact_instruments());
  const PracticeClosing closing = device.close(1, plain_step(), window);
  const Ensemble ensemble(device.nominal(), 1);
  const Closing own = simulate(prepare(ensemble.scene(device.device().values)), false);
  EXPECT_EQ(closing.motion.initial_contact_time, own.metrics.initial_contact_time);
  EXPECT_EQ(closing.motion.major_bounce_height, own.metrics.major_bounce_height);
  // The record must have the touches of the run, one by one.
  const std::vector<Touch>& touches = own.trajectory.touches;
  ASSERT_GT(touches.size(), 3U);
  ASSERT_GE(closing.record.edges.size(), 2 * touches.size() - 1);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    EXPECT_EQ(closing.record.edges[2 * i].time, touches[i].begin);
    EXPECT_TRUE(closing.record.edges[2 * i].closed);
    if (std::isnan(touches[i].end)) break;
    EXPECT_EQ(closing.record.edges[2 * i + 1].time, touches[i].end);
  }
  EXPECT_EQ(record_fault(closing.record), "");
}

TEST(PracticeDevice, DependsOnItsSeedAndTheNumberOfTheShotAlone) {
  const PracticeDevice one(gold_at_17_volts()), again(gold_at_17_volts()), other(gold_at_17_volts(), {.seed = 2});
  const double late = one.close(7, plain_step(), window).record.edges.front().time;
  const double first = one.close(1, plain_step(), window).record.edges.front().time;
  EXPECT_EQ(again.close(7, plain_step(), window).record.edges.front().time, late);
  EXPECT_NE(first, late) << "edges and gain scatter from shot to shot";
  EXPECT_NE(other.device().values, one.device().values);
}

// A practice device is unknown to searches and beliefs: it has no number in common with devices of an ensemble.
TEST(PracticeDevice, SharesNoNumberWithAnEnsemble) {
  constexpr std::size_t many = 2000;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const PracticeDevice device(gold_at_17_volts(), {.seed = seed});
    for (const PointSet set : {PointSet::sobol, PointSet::monte_carlo}) {
      for (std::uint64_t other = 0; other <= 4; ++other) {
        const Ensemble ensemble(device.nominal(), many, other, set);
        for (std::size_t k = 0; k < many; ++k) {
          const std::vector<double> values = ensemble.values(k);
          for (const double value : values)
            ASSERT_THAT(device.device().values, testing::Not(testing::Contains(value))) << seed << ' ' << other << ' ' << k;
        }
      }
    }
  }
}

TEST(PracticeDevice, HasErrorsOfTheSizesThatWereAskedFor) {
  PracticeOptions options = exact_instruments();
  const double exact = PracticeDevice(gold_at_17_volts(), options).close(1, plain_step(), window).record.edges.front().time;
  options.laboratory.edge_error = 50e-9;
  const PracticeDevice device(gold_at_17_volts(), options);
  constexpr int shots = 100;
  double sum = 0, squares = 0;
  for (int n = 1; n <= shots; ++n) {
    const double error = device.close(static_cast<std::uint64_t>(n), plain_step(), 40e-6).record.edges.front().time - exact;
    sum += error, squares += error * error;
  }
  // The standard deviation of 100 samples has an error of 7 %, their mean one of a tenth of the deviation: allow four times
  // these.
  EXPECT_NEAR(std::sqrt(squares / shots), 50e-9, 0.28 * 50e-9);
  EXPECT_NEAR(sum / shots, 0, 0.4 * 50e-9);
}

TEST(PracticeDevice, GetsTheVoltsTimesTheGainOfItsSources) {
  PracticeOptions options = exact_instruments();
  const auto closing_time = [&](std::uint64_t shot) {
    return PracticeDevice(gold_at_17_volts(), options).close(shot, plain_step(), 40e-6).motion.initial_contact_time;
  };
  const double exact = closing_time(1);
  options.drift = 1e-4;
  EXPECT_EQ(closing_time(1), exact) << "the first shot is before any drift";
  const Closing higher = [&] {
    const PracticeDevice device(gold_at_17_volts(), exact_instruments());
    SceneFile file = Ensemble(device.nominal(), 1).scene(device.device().values);
    file.set_waveform("main", Step{.level = 17.771 * (1 + 1e-4 * 999)});
    return simulate(prepare(file), false);
  }();
  EXPECT_NEAR(closing_time(1000), higher.metrics.initial_contact_time, 1e-9 * exact);
  options = exact_instruments();
  options.laboratory.gain_error = 0.01;
  const double off = closing_time(1);
  EXPECT_NE(off, exact);
  EXPECT_EQ(closing_time(2), off) << "the gain is constant";
  options.laboratory.shot_error = 0.001;
  EXPECT_NE(closing_time(1), closing_time(2));
}

TEST(PracticeDevice, ShowsNoOpeningShorterThanItsInstrumentResolves) {
  PracticeOptions options = exact_instruments();
  const auto seen = [&] { return PracticeDevice(gold_at_17_volts(), options).close(1, plain_step(), window).record; };
  const ContactRecord all = seen();
  std::vector<double> lengths;
  for (const ContactOpening& opening : openings(all)) lengths.push_back(opening.end - opening.begin);
  std::ranges::sort(lengths);
  options.laboratory.unseen = lengths[lengths.size() / 2];
  const ContactRecord coarse = seen();
  std::vector<double> expected;
  for (const ContactOpening& opening : openings(all)) {
    if (opening.end - opening.begin > options.laboratory.unseen) expected.push_back(opening.begin);
  }
  std::vector<double> begins;
  for (const ContactOpening& opening : openings(coarse)) begins.push_back(opening.begin);
  EXPECT_EQ(begins, expected);
  EXPECT_GT(begins.size(), 1U);
  EXPECT_LT(begins.size(), lengths.size());
}

// With errors as large as the openings the record is still valid.
TEST(PracticeDevice, KeepsItsEdgesInOrderHoweverLargeTheirErrors) {
  PracticeOptions options;
  options.laboratory.edge_error = 2e-6, options.laboratory.unseen = 0;
  const PracticeDevice device(gold_at_17_volts(), options);
  for (std::uint64_t shot = 1; shot <= 20; ++shot)
    EXPECT_EQ(record_fault(device.close(shot, plain_step(), window).record), "") << shot;
}

TEST(PracticeDevice, FollowsAnotherModelWhereItIsAskedTo) {
  PracticeOptions options = exact_instruments();
  const auto touch = [&] { return PracticeDevice(gold_at_17_volts(), options).close(1, plain_step(), 60e-6).motion; };
  const Metrics own = touch();
  options.model = {.more_modes = 1};
  EXPECT_EQ(PracticeDevice(gold_at_17_volts(), options).device().model->modes(), 5);
  EXPECT_NE(touch().initial_contact_time, own.initial_contact_time);
  options.model = {.gas = "veijola"};
  EXPECT_GT(std::abs(touch().initial_contact_time - own.initial_contact_time), 1e-9);
  options.model = {.stiffness = 1.1};
  EXPECT_EQ(touch().initial_contact_time, own.initial_contact_time) << "nothing is stiffer before the touch";
  EXPECT_NE(touch().peak_contact_force, own.peak_contact_force);
  options.model = {.set = {"gap.contact=2.1 um"}};
  EXPECT_GT(touch().initial_contact_time, own.initial_contact_time);
}

TEST(PracticeDevice, HasNoEdgeInTheRecordIfItDoesNotClose) {
  const PracticeDevice device(gold_at_17_volts());
  const ContactRecord record = device.close(1, {Step{.level = 1}}, window).record;
  EXPECT_EQ(record.error, "");
  EXPECT_TRUE(record.edges.empty());
  EXPECT_FALSE(first_touch(record).has_value());
}

TEST(PracticeDevice, RefusesShotsThatNoLaboratoryWouldFire) {
  const PracticeDevice device(gold_at_17_volts());
  EXPECT_THAT(refusal([&] { (void)device.close(1, {Step{.level = 26}}, window); }),
              testing::AllOf(HasSubstr("drives.main"), HasSubstr("25")));
  EXPECT_THAT(refusal([&] { (void)device.close(0, plain_step(), window); }), HasSubstr("counted from 1"));
  EXPECT_THAT(refusal([&] { (void)device.close(1, plain_step(), std::nan("")); }), HasSubstr("longer than 0 s"));
  EXPECT_THAT(refusal([] { PracticeDevice(scene("purdue-nickel.toml")); }), HasSubstr("needs a [contact]"));
  EXPECT_THAT(refusal([] { PracticeDevice(gold_at_17_volts(), {.model = {.gas = "air"}}); }), HasSubstr("gas=air: must be "));
  EXPECT_THAT(refusal([] {
                SceneFile file = gold_at_17_volts();
                file.erase("gas");
                PracticeDevice(file, {.model = {.gas = "veijola"}});
              }),
              HasSubstr("there is no [gas]"));
}

}  // namespace
}  // namespace softland
