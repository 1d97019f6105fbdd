// The devices of a belief, and their closings.
#include "studies/inverse/tuning_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "studies/inverse/proposal.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

using Eigen::VectorXd;

Eigen::Index coordinate(const TuningModel& scene, std::string_view name) {
  const auto& all = scene.nominal().scene.spread.variables;
  return std::ranges::find(all, name, &SpreadVariable::name) - all.begin();
}

TEST(TuningModels, TheOriginIsTheNominalDevice) {
  const TuningModel scene(gold_with_two_modes(), {.vectors = Vectors::none}, {});
  const std::vector<VectorXd> origin{VectorXd::Zero(scene.size())};
  const std::vector<Particle> devices = scene.devices(origin);
  const Device& own = devices[0].sampled.model->device();
  const Device& nominal = scene.nominal().scene.device;
  EXPECT_DOUBLE_EQ(own.structure.thickness, nominal.structure.thickness);
  EXPECT_DOUBLE_EQ(own.gap.contact, nominal.gap.contact);
  constexpr double median_of_lognormal = 0.006;  // distance of the median below the mean for a deviation of 10 %
  EXPECT_NEAR(number_of(own.contacts.front().model, "effective_modulus", 0) /
                  number_of(nominal.contacts.front().model, "effective_modulus", 0),
              1, median_of_lognormal);
}

TEST(TuningModels, TheGapsShareTheirFactorAndTheContactGapHasOneOfItsOwn) {
  const TuningModel scene(gold_with_two_modes(), {.vectors = Vectors::none}, {});
  const auto factors = [&](const VectorXd& z) {
    const std::vector<VectorXd> points{z};
    const Gap gap = scene.devices(points)[0].sampled.model->device().gap, nominal = scene.nominal().scene.device.gap;
    return std::pair{gap.electrode / nominal.electrode, gap.contact / nominal.contact};
  };
  constexpr double rounding = 1e-9;
  const auto [electrode, contact] = factors(VectorXd::Unit(scene.size(), coordinate(scene, "gaps")));
  EXPECT_NEAR(electrode, 1.02, rounding);
  EXPECT_NEAR(contact, 1.02, rounding);
  const auto [same, alone] = factors(VectorXd::Unit(scene.size(), coordinate(scene, "gap.contact")));
  EXPECT_NEAR(same, 1, rounding);
  EXPECT_NEAR(alone, 1.03, rounding);
}

TEST(TuningModels, TheContactsThatMakeTheConnectionHaveOneFactorTogether) {
  const TuningModel tuned(scene("new/two-contacts.toml", {"structure.modes=2"}), {}, {});
  const auto factors = [&](const char* name) {
    const std::vector<VectorXd> points{VectorXd::Unit(tuned.size(), coordinate(tuned, name))};
    const Device own = tuned.devices(points)[0].sampled.model->device(), nominal = tuned.nominal().scene.device;
    std::vector<double> all{own.gap.electrode / nominal.gap.electrode};
    for (std::size_t c = 0; c < own.contacts.size(); ++c)
      all.push_back(c == 0 ? own.gap.contact / nominal.gap.contact : own.contacts[c].gap / nominal.contacts[c].gap);
    for (std::size_t c = 0; c < own.contacts.size(); ++c)
      all.push_back(number_of(own.contacts[c].model, "stiffness", 0) / number_of(nominal.contacts[c].model, "stiffness", 0));
    return all;
  };
  constexpr double rounding = 1e-9, lognormal = 0.12;
  const auto near = [](double factor) { return testing::DoubleNear(factor, rounding); };
  EXPECT_EQ(tuned.gap_ratio_name(), "contact gaps / gap.electrode");
  const std::vector<double> shared = factors("gaps"), own = factors("contact gaps"), stiffness = factors("contact stiffness");
  const double soft = shared[4];  // the median of a lognormal factor
  EXPECT_NEAR(soft, 1, 0.006);
  EXPECT_THAT(shared, testing::ElementsAre(near(1.02), near(1.02), near(1.02), near(1), near(soft), near(soft), near(1)));
  EXPECT_THAT(own, testing::ElementsAre(near(1), near(1.03), near(1.03), near(1), near(soft), near(soft), near(1)));
  EXPECT_GT(stiffness[4], 1 + lognormal / 2);
  EXPECT_DOUBLE_EQ(stiffness[5], stiffness[4]);
  EXPECT_EQ(stiffness[6], 1) << "a back stop makes no connection";
}

TEST(LandingCosts, PriceTheTouchOfAFastApproachAndTheContactOfASlowOne) {
  const PredictedClosing soft{.followed = true, .touch = 400e-6, .openings = {{.begin = 401e-6, .end = 600e-6}}};
  TuningScales scales{.closing_time = 20e-6, .gap = 2e-6, .rebound = 1e-9};
  EXPECT_DOUBLE_EQ(landing_cost(soft, scales).time, 0.34 * (20 - 0.88));
  scales.permanent_contact = 500e-6;
  EXPECT_DOUBLE_EQ(landing_cost(soft, scales).time, 0.02 * (600.0 / 500 - 1));
  scales.permanent_contact = 700e-6;
  EXPECT_EQ(landing_cost(soft, scales).time, 0);
  PredictedClosing open = soft;
  open.openings.back().end = std::numeric_limits<double>::infinity();
  EXPECT_DOUBLE_EQ(landing_cost(open, scales).time, 0.34 * (20 - 0.88)) << "as a fast approach pays, at most";
  scales.latest_touch = 100e-6;
  EXPECT_GT(landing_cost(soft, scales).time, 10) << "a touch that was asked for earlier";
}

TEST(TuningModels, AScenesOwnSpreadIsNotVariedTwice) {
  const TuningModel scene(gold({"structure.modes=2", "spread.\"gas.viscosity\"={distribution=\"normal\",cov=\"1 %\"}"}),
                          {.vectors = Vectors::none}, {});
  const auto& all = scene.nominal().scene.spread.variables;
  const auto film = std::ranges::find(all, "gas.viscosity", &SpreadVariable::name);
  ASSERT_NE(film, all.end());
  EXPECT_EQ(film->distribution.kind(), DistributionKind::normal);
  EXPECT_EQ(std::ranges::count(all, "gas.viscosity", &SpreadVariable::name), 1);
}

TEST(TuningModels, AClosingInLanesIsThatOfTheDeviceAlone) {
  const TuningModel one_by_one(gold_with_two_modes(), {.vectors = Vectors::none}, {}), in_lanes(gold_with_two_modes(), {}, {});
  if (!in_lanes.is_in_lanes()) GTEST_SKIP() << "skipped: no AVX2";
  std::vector<VectorXd> points;
  for (Eigen::Index k = 0; k < in_lanes.size(); ++k) points.push_back(VectorXd::Unit(in_lanes.size(), k));
  const std::vector<Waveform> step{Step{.level = in_lanes.nominal().signals()[0].hold_level()}};
  const auto close = [&](const TuningModel& scene) {
    const std::vector<Particle> devices = scene.devices(points);
    std::vector<PredictedShot> shots;
    for (const Particle& device : devices) shots.push_back({.device = &device, .waveforms = &step});
    return scene.close(shots);
  };
  const std::vector<PredictedClosing> a = close(one_by_one), b = close(in_lanes);
  constexpr double of_tolerance = 1e-4;
  for (std::size_t k = 0; k < points.size(); ++k) {
    ASSERT_TRUE(a[k].closes() && b[k].closes()) << k;
    EXPECT_FALSE(!(std::abs(a[k].touch / b[k].touch - 1) <= of_tolerance)) << k;
    EXPECT_FALSE(!(std::abs(a[k].speed / b[k].speed - 1) <= of_tolerance)) << k;
    ASSERT_FALSE(a[k].openings.empty() || b[k].openings.empty()) << k;
    EXPECT_FALSE(!(std::abs(a[k].openings[0].begin / b[k].openings[0].begin - 1) <= of_tolerance)) << k;
  }
}

TEST(TuningModels, ADelayMovesTheRecordAndNothingElse) {
  const TuningModel scene(gold_with_two_modes(), {}, {});
  const std::vector<VectorXd> points{VectorXd::Zero(scene.size()), VectorXd::Unit(scene.size(), scene.size() - 1)};
  const std::vector<Waveform> step{Step{.level = scene.nominal().signals()[0].hold_level()}};
  const std::vector<Particle> devices = scene.devices(points);
  const std::vector<PredictedShot> shots{{.device = &devices[0], .waveforms = &step},
                                         {.device = &devices[1], .waveforms = &step}};
  const std::vector<PredictedClosing> closings = scene.close(shots);
  EXPECT_EQ(closings[1].touch, closings[0].touch);
  EXPECT_DOUBLE_EQ(closings[1].recorded_touch(), closings[0].touch - scene.delay_deviation());
  EXPECT_EQ(closings[1].highest, closings[0].highest);
  EXPECT_EQ(closings[1].openings.size(), closings[0].openings.size());
}

TEST(TuningModels, UnitsFollowThePullInVoltageAndThePeriod) {
  const TuningModel scene(gold_with_two_modes(), {.vectors = Vectors::none}, {});
  const auto of = [&](const char* name) {
    const VectorXd z = VectorXd::Unit(scene.size(), coordinate(scene, name));
    const std::vector<VectorXd> points{z};
    const std::vector<Particle> devices = scene.devices(points);
    return std::pair{scene.units(z), devices[0].sampled.model->basis().angular_frequencies()[0]};
  };
  constexpr double second_order = 2e-3;
  const auto [thicker, frequency] = of("structure.thickness");
  EXPECT_NEAR(thicker.volts, std::pow(1.02, 1.5), second_order);  // Vdp is proportional to the root of the bending stiffness
  EXPECT_NEAR(thicker.time, scene.nominal().model.basis().angular_frequencies()[0] / frequency, second_order);
  EXPECT_NEAR(of("driver.main.gain").first.volts, 1 / 1.005, second_order);
}

TEST(TuningModels, AtASafeLevelNoneOfAThousandDevicesCollapses) {
  const TuningModel scene(gold({"structure.modes=2", "contact.effective_modulus=1 GPa"}), {.vectors = Vectors::none}, {});
  const double safe = scene.safe_level(NormalBelief::standard(scene.size()));
  const double known =
      scene.safe_level({.mean = VectorXd::Zero(scene.size()), .covariance = Eigen::MatrixXd::Zero(scene.size(), scene.size())});
  const double nominal = pull_through_voltage(scene.nominal().model, 0, std::vector{scene.nominal().signals()[0].hold_level()});
  ASSERT_TRUE(std::isfinite(nominal));
  constexpr double precision = 5e-3;  // the median of a lognormal modulus is below the scene's value
  EXPECT_NEAR(known / nominal, 1, precision);
  EXPECT_LT(safe, known);
}

TEST(TuningModels, AScenesWithoutAContactIsRefused) {
  SceneFile file = gold_with_two_modes();
  file.erase("contact");
  EXPECT_THROW(TuningModel(file, {}, {}), InvalidInput);
}

}  // namespace
}  // namespace softland
