// Tests ranges over a box, and polynomial chaos, against samples of devices.
#include "studies/devices/box_and_chaos.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "sampling/polynomial_chaos.h"
#include "sampling/statistics.h"
#include "scenes.h"

namespace softland::other_ways_test {
namespace {

constexpr std::string_view two_normal =
    R"(spread={"structure.thickness"={distribution="normal", cov="2 %"}, "structure.youngs_modulus"={distribution="normal", cov="3 %"}})";

struct Judged {
  PreparedScene nominal;
  RobustnessOptions options;
  Robustness found;
  [[nodiscard]] const DriveRobustness& drive() const { return found.drives.back(); }
  [[nodiscard]] BoxAndChaos ways(const BoxAndChaosOptions& effort, const Progress& progress = {}) const {
    return box_and_chaos(nominal, drive(), options, effort, progress);
  }
};
Judged judged(const SceneFile& file, std::uint64_t samples, const Calibration& calibration = {}) {
  Judged all{.nominal = prepare(file), .options = {.samples = samples, .jobs = 2}, .found = {}};
  all.found = robustness(all.nominal, {{.name = "own", .waveforms = all.nominal.drives.waveforms(), .calibration = calibration}},
                         all.options);
  return all;
}
Metrics alone(const Judged& all, const SceneFile& device) {
  const PreparedScene own = prepare(SceneFile::parse(device.text(), "alone.toml"));
  EXPECT_TRUE(own.scene.calibration.is_empty());
  return metrics(simulate_closing(own.model, own.signals(), {.duration = all.found.duration, .tolerance = all.found.tolerance}),
                 own.scene.metrics);
}

const Judged& gold() {
  static const Judged all = judged(gold_at_17_volts({two_normal}), 400);
  return all;
}
const BoxAndChaos& gold_ways() {
  static const BoxAndChaos ways = gold().ways({.closings_per_search = 60, .most_fitted = 100});
  return ways;
}

TEST(Box, HoldsNineteenOfTwentyDevices) {
  for (const std::size_t d : {1U, 2U, 3U, 20U})
    EXPECT_NEAR(std::pow(std::erf(box_half_width(d) / std::sqrt(2.0)), static_cast<double>(d)), box_share, 1e-12) << d;
  EXPECT_NEAR(static_cast<double>(gold_ways().sampled_inside), box_share * 400, 4) << "Sobol' points fill it evenly";
}

// First contact is later for a thicker and for a stiffer beam, so that its range ends in two corners of the box.
TEST(Box, HasTheLatestAndTheEarliestFirstContactInItsCorners) {
  const double b = box_half_width(2);
  const FigureRange& first_contact = gold_ways().ranges[0];
  ASSERT_EQ(first_contact.key, "initial_contact_time_s");
  for (const double side : {-1.0, 1.0}) {
    const BoxDevice& end = side > 0 ? first_contact.most : first_contact.least;
    ASSERT_EQ(end.values.size(), 2U);
    constexpr double rounding = 1e-12;  // rounding of the normal distribution and its inverse
    EXPECT_NEAR(end.values[0], 1 + side * b * 0.02, rounding);
    EXPECT_NEAR(end.values[1], 1 + side * b * 0.03, rounding);
    SceneFile corner = without(gold_at_17_volts(), "spread");
    corner.assign("structure.thickness", 2e-6 * (1 + side * b * 0.02));
    corner.assign("structure.youngs_modulus", 78e9 * (1 + side * b * 0.03));
    EXPECT_NEAR(end.figure, alone(gold(), corner).initial_contact_time, 1e-9 * end.figure);
  }
}

TEST(Box, FindsNothingBetterThanNoSampledDeviceInside) {
  for (const FigureRange& range : gold_ways().ranges) {
    EXPECT_LE(range.least.figure, range.of_sample.low) << range.key;
    EXPECT_GE(range.most.figure, range.of_sample.high) << range.key;
    EXPECT_LT(range.of_sample.low, range.of_sample.high);
    // The largest figure in a box with 95 % of the devices is not below the 95th percentile.
    const auto& figures = gold().drive().figures;
    EXPECT_GE(range.most.figure, figures[figure_of(range.key)].quantiles[2].value) << range.key;
  }
  EXPECT_LE(gold_ways().closings, 6 * 60);
  EXPECT_GT(gold_ways().closings, 6 * 30);
}

TEST(Box, GivesTheSceneOfItsDevices) {
  const auto check = [](const Judged& all, const BoxAndChaos& ways) {
    for (const FigureRange& range : ways.ranges) {
      const Metrics own = alone(all, scene_of_device(all.nominal, all.drive(), range.most, all.options));
      EXPECT_EQ(own.initial_contact_time, range.most.outcome.metrics.initial_contact_time) << range.key;
      EXPECT_EQ(own.major_bounce_height, range.most.outcome.metrics.major_bounce_height) << range.key;
    }
  };
  check(gold(), gold_ways());
  // These devices are driven in their own units, which are measured without error.
  const Judged measured = judged(gold_at_17_volts({two_normal, "waveform.main.rise_time=20 us"}), 8,
                                 {.pull_in_error = 0.02, .frequency_error = 0.02});
  const BoxAndChaos ways = measured.ways({.closings_per_search = 30});
  check(measured, ways);
  // Every device touches after the same number of its own periods, which are inversely proportional to thickness times the root
  // of the modulus.
  const auto in_periods = [](const BoxDevice& device) { return device.figure * device.values[0] * std::sqrt(device.values[1]); };
  const FigureRange& first_contact = ways.ranges[0];
  constexpr double damped_by_gas = 0.01;
  EXPECT_NEAR(in_periods(first_contact.most), in_periods(first_contact.least), damped_by_gas * first_contact.most.figure);
  EXPECT_GT(first_contact.most.figure, 1.1 * first_contact.least.figure);
}

TEST(Box, HasADeviceThatDoesNotCloseAsItsWorst) {
  // 1.25 Vdp is the pull-in voltage of a beam whose thickness is larger by 1.25^(2/3) - 1 = 16 %. The box ends at 1.96 * 12 %.
  const Judged wide = judged(gold_at_17_volts({R"(spread={"structure.thickness"={distribution="normal", cov="12 %"}})"}), 64);
  const BoxAndChaos ways = wide.ways({.closings_per_search = 40});
  for (const FigureRange& range : ways.ranges) {
    EXPECT_TRUE(std::isinf(range.most.figure)) << range.key;
    EXPECT_FALSE(range.most.outcome.closed());
    EXPECT_TRUE(std::isfinite(range.least.figure));
    EXPECT_LT(range.least.figure, range.of_sample.high);
  }
  EXPECT_LE(ways.closings, 3 * 40 + 3 * 3) << "nothing is worse, so that these searches end";
  // Polynomial chaos is fitted to the devices that close.
  std::size_t closed = 0;
  for (const DeviceOutcome& o : wide.drive().outcomes) closed += o.closed();
  EXPECT_LT(closed, 64U);
  EXPECT_EQ(ways.chaos[0].fitted, closed);
  EXPECT_EQ(ways.left_out, 64 - closed);
}

TEST(Box, DoesNotDependOnThreads) {
  Judged other = gold();
  for (const int jobs : {1, 3}) {
    other.options.jobs = jobs;
    const BoxAndChaos ways = other.ways({.closings_per_search = 60, .most_fitted = 100});
    EXPECT_EQ(ways.closings, gold_ways().closings);
    for (std::size_t i = 0; i < ways.ranges.size(); ++i) {
      EXPECT_EQ(ways.ranges[i].most.values, gold_ways().ranges[i].most.values);
      EXPECT_EQ(ways.ranges[i].least.figure, gold_ways().ranges[i].least.figure);
      EXPECT_EQ(ways.chaos[i].mean, gold_ways().chaos[i].mean);
    }
  }
}

TEST(BoxAndChaos, EndWhenAskedToStop) {
  const std::atomic<bool> stop = true;
  const BoxAndChaos ways = gold().ways({.closings_per_search = 60}, {.stop = &stop});
  EXPECT_TRUE(ways.ranges.empty());
  EXPECT_EQ(ways.why_none, "interrupted");
}

TEST(Chaos, AgreesWithTheSampleWhereTheFigureIsSmooth) {
  const FigureChaos& chaos = gold_ways().chaos[0];
  const FigureStatistics& sampled = gold().drive().figures[&Metrics::initial_contact_time];
  EXPECT_EQ(chaos.fitted, 100U);
  EXPECT_EQ(chaos.unseen, 300U);
  EXPECT_GT(chaos.q2, 0.9999);
  EXPECT_GT(chaos.q2_unseen, 0.999);
  EXPECT_NEAR(chaos.mean, sampled.mean, 2e-3 * sampled.standard_deviation + 1e-4 * sampled.mean);
  EXPECT_NEAR(chaos.standard_deviation, sampled.standard_deviation, 0.03 * sampled.standard_deviation);
  EXPECT_GT(chaos.quantile_95, sampled.quantiles[2].interval.low);
  EXPECT_LT(chaos.quantile_95, sampled.quantiles[2].interval.high);
}

// The same polynomials and their error on other devices, from the root mean square of the residuals.
TEST(Chaos, SaysHowMuchItMissesOfOtherDevices) {
  const Ensemble ensemble(gold().nominal, 400);
  for (const FigureChaos& chaos : gold_ways().chaos) {
    std::vector<double> figures;
    Eigen::MatrixXd points(400, 2);
    for (std::size_t k = 0; k < 400; ++k) {
      figures.push_back(gold().drive().outcomes[k].of(figure_of(chaos.key)));
      for (std::size_t i = 0; i < 2; ++i) points(static_cast<long>(k), static_cast<long>(i)) = ensemble.point(k)[i];
    }
    const std::vector<double> others(figures.begin() + 100, figures.end());
    const PolynomialChaos own({Germ::normal, Germ::normal}, points.topRows(100), std::span(figures).first(100));
    double squares = 0;
    for (std::size_t k = 100; k < 400; ++k) squares += std::pow(own(ensemble.point(k)) - figures[k], 2);
    const double relative = std::sqrt(squares / 299) / sample_standard_deviation(others);
    EXPECT_NEAR(chaos.q2_unseen, 1 - relative * relative, 1e-9) << chaos.key;
    EXPECT_EQ(chaos.terms, own.terms());
  }
  EXPECT_LT(gold_ways().chaos[2].q2_unseen, 0.9) << "the highest rebound jumps";
}

}  // namespace
}  // namespace softland::other_ways_test
