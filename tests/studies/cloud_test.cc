// A closing repeated under imperceptibly perturbed drives.
#include "studies/closing/cloud.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <set>

#include "scenes.h"
#include "studies/closing/prepared.h"

namespace softland {
namespace {

std::vector<double> first_touches(const CloudOptions& options) {
  const PreparedScene p =
      prepare(gold({"waveform.main.level=17.771 V", "driver.main.max_voltage=25 V", "simulate.duration=40 us"}));
  std::vector<double> times;
  for (const Trajectory& t : perturbed_closings(p.model, p.signals(), {.duration = p.duration, .tolerance = 1e-10}, options))
    times.push_back(t.touches.at(0).begin);
  return times;
}

TEST(Cloud, IsAFunctionOfItsArgumentsAlone) {
  const std::vector<double> times = first_touches({.runs = 4});
  EXPECT_EQ(times, first_touches({.runs = 4}));
  EXPECT_NE(times, first_touches({.runs = 4, .seed = 2}));
  const std::vector<double> all = first_touches({});
  EXPECT_EQ(std::set<double>(all.begin(), all.end()).size(), 16U) << "one drive is enough for as many runs";
}

TEST(Cloud, IsTheSameForAnyNumberOfJobs) {
  const std::vector<double> alone = first_touches({});
  for (const int jobs : {2, 3, 8}) EXPECT_EQ(first_touches({.jobs = jobs}), alone) << jobs;
}

TEST(Cloud, AskedToStopKeepsTheRunsThatAreComplete) {
  const PreparedScene p =
      prepare(gold({"waveform.main.level=17.771 V", "driver.main.max_voltage=25 V", "simulate.duration=40 us"}));
  const auto runs = [&](int jobs, std::atomic<bool>& stop, const Progress& progress) {
    return perturbed_closings(p.model, p.signals(), {.duration = p.duration, .tolerance = 1e-10, .stop = &stop}, {.jobs = jobs},
                              progress);
  };
  for (const int jobs : {1, 2, 8}) {
    std::atomic<bool> stop = false;
    int told = 0;
    const Progress progress{.report = [&](std::string_view, double part) {
      EXPECT_GT(part, 0);
      EXPECT_LE(part, 1);
      if (++told == 3) stop = true;
    }};
    const std::vector<Trajectory> found = runs(jobs, stop, progress);
    EXPECT_LT(found.size(), 16u) << jobs;
    if (jobs == 1) {
      EXPECT_EQ(found.size(), 3u);
    }
    for (const Trajectory& t : found) EXPECT_EQ(t.status, Status::done);
  }
}

// A higher step closes sooner: d ln t_i / d ln V is -1.6 at this level.
TEST(Cloud, PerturbsTheDrivesByWhatWasAsked) {
  const PreparedScene p =
      prepare(gold({"waveform.main.level=17.771 V", "driver.main.max_voltage=25 V", "simulate.duration=40 us"}));
  const double own = simulate_closing(p.model, p.signals(), {.duration = p.duration, .tolerance = 1e-10}).touches.at(0).begin;
  bool sooner = false, later = false;
  for (const double size : {1e-6, 1e-4}) {
    for (const double time : first_touches({.runs = 6, .smallest = size, .largest = size})) {
      EXPECT_NEAR(std::abs(time / own - 1), 1.6 * size, 0.5 * size);
      (time < own ? sooner : later) = true;
    }
  }
  EXPECT_TRUE(sooner && later);
  for (const double time : first_touches({.runs = 6, .smallest = 1e-6, .largest = 1e-4})) {
    EXPECT_GT(std::abs(time / own - 1), 1e-6);
    EXPECT_LT(std::abs(time / own - 1), 3e-4);
  }
}

TEST(Spread, IsOverTheFiniteValues) {
  const Spread all = spread({3, Metrics::unset, 1, 10, 2});
  EXPECT_EQ(all.low, 1);
  EXPECT_EQ(all.median, 2.5);
  EXPECT_EQ(all.high, 10);
  EXPECT_EQ(all.runs, 4);
  EXPECT_EQ(spread({5, 1, 7}).median, 5);
  EXPECT_TRUE(std::isnan(spread({Metrics::unset}).median));
}

TEST(IllConditioned, IsAFigureThatSpreadsByMoreThanAThousandfoldPerturbation) {
  EXPECT_FALSE(ill_conditioned(Spread{.low = 1, .high = 1 + 0.9 * ill_conditioned_range, .runs = 16}));
  EXPECT_TRUE(ill_conditioned(Spread{.low = 1, .high = 1 + 1.1 * ill_conditioned_range, .runs = 16}));
  EXPECT_TRUE(ill_conditioned(Spread{.low = -1 - 1.1 * ill_conditioned_range, .high = -1, .runs = 16}))
      << "energy that flows back";
  EXPECT_TRUE(ill_conditioned(Spread{.low = 0, .high = 1, .runs = 16})) << "a rebound in some runs only";
  EXPECT_FALSE(ill_conditioned(Spread{.low = 0, .high = 0, .runs = 16}));
  EXPECT_FALSE(ill_conditioned(Spread{})) << "in no run";
}

}  // namespace
}  // namespace softland
