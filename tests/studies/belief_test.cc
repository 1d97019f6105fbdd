// Tests the belief that follows from records of a device.
#include "studies/inverse/belief.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/studies/scenes.h"

namespace softland {
namespace {

using Eigen::VectorXd;

class Beliefs : public testing::Test {
 protected:
  [[nodiscard]] std::vector<Waveform> step(double share) const { return {Step{.level = share * hold_}}; }
  [[nodiscard]] std::vector<LearnedShot> records_of(const VectorXd& z) const {
    const std::vector<VectorXd> points{z};
    const std::vector<Particle> device = scene_.devices(points);
    std::vector<LearnedShot> shots;
    for (const double share : {1.0, 1.15, 0.9}) {
      shots.push_back({.waveforms = step(share), .record = {}});
      const std::vector<PredictedShot> one{{.device = &device[0], .waveforms = &shots.back().waveforms}};
      const PredictedClosing closing = scene_.close(one)[0];
      shots.back().record.edges.push_back({closing.recorded_touch(), true});
      for (const ContactOpening& o : closing.openings) {
        if (!std::isfinite(o.end) || o.end - o.begin < scene_.options().laboratory.unseen) continue;
        shots.back().record.edges.push_back({o.begin - closing.delay, false});
        shots.back().record.edges.push_back({o.end - closing.delay, true});
      }
    }
    return shots;
  }

  TuningModel scene_{gold_with_two_modes(), {}, {}};
  double hold_ = scene_.nominal().signals()[0].hold_level();
};

// The terms of the formula in belief.h, computed again from the numbers of one closing.
TEST_F(Beliefs, LikelihoodIsThatOfItsFormula) {
  const TuningScales& s = scene_.scales();
  const double t0 = s.closing_time;
  const PredictedClosing closing{.followed = true,
                                 .touch = t0,
                                 .speed = 0.1,
                                 .fastest = 0.1,
                                 .highest = 1e-9,
                                 .openings = {{1.05 * t0, 1.10 * t0}, {1.2 * t0, 1.2 * t0 + 50e-9}}};
  const double late = 80e-9;
  const ContactRecord record{.edges = {{t0 + late, true}, {1.06 * t0, false}, {1.08 * t0, true}}};
  const std::vector<LearnedShot> shots{{.waveforms = step(1), .record = record}};
  const double deviation = std::sqrt(50e-9 * 50e-9 + std::pow(2e-6 / 2000 / 0.1, 2) + std::pow(t0 / 3400, 2));
  double expected = -late * late / (2 * deviation * deviation);
  // The contact is open for 0.04, 0.05 and 0.05 T_0 in the three spans, and for 0.02 T_0 in each of the record. The second
  // opening is too short to be recorded.
  for (const double open : {0.04, 0.05, 0.05}) {
    const double q = (open - 0.02) / (0.0045 + 0.2 * open);
    expected -= 1.2 * std::log(1 + q * q / 3);
  }
  constexpr double rounding = 1e-9;
  EXPECT_NEAR(Likelihood(scene_, shots).of(std::vector{closing}), expected, rounding * std::abs(expected));
}

TEST_F(Beliefs, AMissingTouchIsVeryUnlikely) {
  const PredictedClosing open{.followed = true};
  const std::vector<LearnedShot> touched{{.waveforms = step(1), .record = {.closing_time = 30e-6}}},
      none{{.waveforms = step(1), .record = {}}};
  EXPECT_LT(Likelihood(scene_, touched).of(std::vector{open}), -100);
  EXPECT_EQ(Likelihood(scene_, none).of(std::vector{open}), 0);
}

TEST_F(Beliefs, ALouderImpactIsAFasterOne) {
  const auto closing = [](double speed) {
    return PredictedClosing{.followed = true, .touch = 30e-6, .speed = speed, .fastest = speed};
  };
  const auto shot = [&](double loudness) {
    return LearnedShot{.waveforms = step(1), .record = {.closing_time = 30e-6, .loudness = loudness}};
  };
  const std::vector<LearnedShot> shots{shot(2), shot(20)};
  const Likelihood likelihood(scene_, shots);
  EXPECT_GT(likelihood.of(std::vector{closing(0.01), closing(0.1)}),
            likelihood.of(std::vector{closing(0.1), closing(0.01)}) + 10);
}

TEST_F(Beliefs, ADeviceIsRecoveredFromItsRecords_optimized) {
  VectorXd z = VectorXd::Zero(scene_.size());
  z[0] = 1.3, z[1] = -0.8, z[2] = 0.6;
  const std::vector<LearnedShot> shots = records_of(z);
  Draws draws(7, 0);
  const Belief prior = Belief::prior(scene_.size(), draws);
  const Belief belief = updated_belief(scene_, shots, prior, draws);
  EXPECT_NEAR(std::accumulate(belief.weights.begin(), belief.weights.end(), 0.0), 1, 1e-12);
  // The belief predicts the quantities on which a landing depends: here the touch time of a waveform that was not shot.
  const std::vector<Waveform> other = step(0.95);
  const auto touches = [&](const std::vector<VectorXd>& points) {
    const std::vector<Particle> devices = scene_.devices(points);
    std::vector<PredictedShot> all;
    for (const Particle& device : devices) all.push_back({.device = &device, .waveforms = &other});
    std::vector<double> times;
    for (const PredictedClosing& closing : scene_.close(all)) times.push_back(closing.touch);
    return times;
  };
  const double truth = touches({z})[0], nominal = touches({VectorXd::Zero(scene_.size())})[0];
  double mean = 0;
  const std::vector<double> believed = touches(belief.points);
  for (std::size_t k = 0; k < believed.size(); ++k) mean += belief.weights[k] * believed[k];
  constexpr double three_edges = 150e-9;
  EXPECT_GT(std::abs(truth - nominal), 4 * three_edges);
  EXPECT_FALSE(!(std::abs(mean - truth) <= three_edges)) << mean << " " << truth;
  // The whole of z lies within what is believed.
  const VectorXd off = z - belief.moments.mean;
  for (Eigen::Index k = 0; k < z.size(); ++k)
    EXPECT_LT(std::abs(off[k]), 4 * std::sqrt(belief.moments.covariance(k, k)) + 0.05) << k;
}

// Records with a delay of 1 us are explained by the delay of the trigger, and not by another device.
TEST_F(Beliefs, ALateTriggerIsLearnedAsADelay_optimized) {
  constexpr double late = 1e-6;
  VectorXd z = VectorXd::Zero(scene_.size());
  z[scene_.size() - 1] = late / scene_.delay_deviation();
  const std::vector<LearnedShot> shots = records_of(z);
  const auto gaps_and_delay = [&](const TuningModel& scene) {
    Draws draws(7, 0);
    const Belief belief = updated_belief(scene, shots, Belief::prior(scene.size(), draws), draws);
    return std::pair{scene.devices(std::vector<VectorXd>{belief.moments.mean})[0].sampled.model->device().gap.contact /
                         scene.nominal().scene.device.gap.contact,
                     scene.delay(belief.moments.mean)};
  };
  constexpr double one_percent = 0.01;
  const auto [gap, delay] = gaps_and_delay(scene_);
  EXPECT_FALSE(!(std::abs(delay - late) <= late / 2)) << delay;
  EXPECT_FALSE(!(std::abs(gap - 1) <= one_percent)) << gap;
  LaboratoryErrors sure;
  sure.trigger_delay = 0;
  const auto [other_gap, none] = gaps_and_delay(TuningModel(gold_with_two_modes(), {.laboratory = sure}, {}));
  EXPECT_LT(std::abs(none), late / 4) << "the user says that there is none";
}

// Devices of the spread, also at three deviations, and records that no device of the spread has.
class Misfits : public Beliefs {
 protected:
  // Returns the closings of a device under steps, with the errors of a laboratory.
  [[nodiscard]] std::vector<LearnedShot> recorded(const VectorXd& z, Draws& draws) const {
    std::vector<LearnedShot> shots = records_of(z);
    const std::vector<VectorXd> points{z};
    const std::vector<Particle> device = scene_.devices(points);
    const Likelihood likelihood(scene_, {});
    for (LearnedShot& shot : shots) {
      const std::vector<PredictedShot> one{{.device = &device[0], .waveforms = &shot.waveforms}};
      const PredictedClosing closing = scene_.close(one)[0];
      shot.record = {};
      if (closing.closes())
        shot.record.closing_time = closing.recorded_touch() + likelihood.touch_deviation(closing.speed) * draws.normal();
    }
    return shots;
  }
  [[nodiscard]] TouchMisfit misfit(const std::vector<LearnedShot>& shots, Draws& draws) const {
    return touch_misfit(scene_, shots, Belief::prior(scene_.size(), draws), draws);
  }
  // Counts the devices of the spread that are rejected. Every tenth device is three deviations away or more.
  [[nodiscard]] int wrongly_called(int devices) const {
    Draws draws(11, 0);
    int wrong = 0;
    for (int n = 0; n < devices; ++n) {
      VectorXd z = draws.normals(scene_.size());
      if (n % 10 == 0) z *= std::max(1.0, 3 / z.norm());
      wrong += misfit(recorded(z, draws), draws).is_beyond();
    }
    return wrong;
  }
};

TEST_F(Misfits, RightDevicesOfTheSpreadAreWithinTheBound_optimized) { EXPECT_EQ(wrongly_called(30), 0); }

TEST_F(Misfits, AtMostOneInAHundredOfAThousandRightDevicesIsBeyondTheBound_slow) {
  constexpr int devices = 1000;
  const int wrong = wrongly_called(devices);
  RecordProperty("wrongly_called", wrong);
  EXPECT_LE(wrong, devices / 100);
}

TEST_F(Misfits, AKnownDeviceInTheTailIsWithinTheBound_optimized) {
  // Devices at 3.5 standard deviations of one quantity, to either side: one in 2000.
  for (Eigen::Index k = 0; k < scene_.size(); ++k) {
    for (const double side : {-3.5, 3.5}) {
      Draws draws(5, 0);
      const TouchMisfit found = misfit(recorded(side * VectorXd::Unit(scene_.size(), k), draws), draws);
      EXPECT_FALSE(found.is_beyond()) << k << " " << side << " " << found.least << " " << found.bound;
      EXPECT_EQ(found.records, 3U);
    }
  }
}

TEST_F(Misfits, RecordsThatNoDeviceHasAreBeyondTheBound_optimized) {
  Draws draws(5, 0);
  std::vector<LearnedShot> same = records_of(VectorXd::Zero(scene_.size()));
  for (LearnedShot& shot : same) shot.record = {.closing_time = 36.1e-6};  // the same touch time under all voltages
  EXPECT_TRUE(misfit(same, draws).is_beyond());
  std::vector<LearnedShot> late = records_of(VectorXd::Zero(scene_.size()));
  for (LearnedShot& shot : late) shot.record = {.closing_time = 150e-6};
  EXPECT_TRUE(misfit(late, draws).is_beyond());
  std::vector<LearnedShot> open = records_of(VectorXd::Zero(scene_.size()));
  open[1].record = {};
  const TouchMisfit once = misfit(open, draws);
  EXPECT_FALSE(once.is_beyond()) << "a wire that came off once";
  EXPECT_EQ(once.records, 2U);
  open[0].record = {};
  EXPECT_TRUE(misfit(open, draws).is_beyond());
}

// The misfit of a fixed ratio is chi-square distributed with one degree of freedom on devices with the ratio of the scene, and
// the square of the deviation on others.
TEST_F(Misfits, AFixedRatioOfTheGapsHasTheExpectedMisfit_optimized) {
  const auto& all = scene_.nominal().scene.spread.variables;
  const Eigen::Index ratio = std::ranges::find(all, "gap.contact", &SpreadVariable::name) - all.begin();
  VectorXd wide = VectorXd::Zero(scene_.size());
  wide[ratio] = 4;
  EXPECT_EQ(*scene_.gap_ratio_coordinate(wide), 4);
  EXPECT_EQ(scene_.with_gap_ratio_of_scene(wide), VectorXd::Zero(scene_.size()));
  Draws draws(5, 0);
  const auto rise = [&](const VectorXd& z) {
    const std::vector<LearnedShot> shots = recorded(z, draws);
    Belief belief = Belief::prior(scene_.size(), draws);
    belief.mode = z;
    return gap_ratio_misfit(scene_, shots, belief, 0, draws);
  };
  constexpr double one_in_two_thousand = 12.1;
  EXPECT_LT(rise(VectorXd::Zero(scene_.size())), one_in_two_thousand);
}

TEST_F(Beliefs, ResamplingKeepsShares) {
  Belief belief{.points = {VectorXd::Constant(1, 1), VectorXd::Constant(1, 2)}, .weights = {0.25, 0.75}};
  Draws draws(3, 0);
  double sum = 0;
  for (const VectorXd& z : belief.resampled(40, draws)) sum += z[0];
  EXPECT_EQ(sum, 10 * 1 + 30 * 2);
}

}  // namespace
}  // namespace softland
