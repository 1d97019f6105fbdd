// Edges of a contact from the voltage across it.
#include "exchange/level_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace softland {
namespace {

Trace trace(std::vector<double> values) {
  Trace made{.times = {}, .values = std::move(values), .note = {}};
  for (std::size_t k = 0; k < made.values.size(); ++k) made.times.push_back(static_cast<double>(k));
  return made;
}

void expect_edges(const std::vector<LevelEdge>& edges, const std::vector<double>& times) {
  constexpr double rounding = 1e-12;
  ASSERT_EQ(edges.size(), times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_NEAR(edges[k].time, times[k], rounding) << k;
    EXPECT_EQ(edges[k].closed, k % 2 == 0) << k;
  }
}

TEST(LevelEdges, AreWhereStraightLinesCrossTheThreshold) {
  expect_edges(level_edges(trace({0, 0, 4, 4, 0, 0, 1, 3}), {.threshold = 1}), {1.25, 3.75, 6});
  expect_edges(level_edges(trace({4, 4, 0, 0, 4, 4}), {.threshold = 1, .is_closed_below = true}), {1.75, 3.25});
}

TEST(LevelEdges, NoiseWithinTheHysteresisIsNone) {
  const Trace noisy = trace({0, 1.2, 0.9, 1.3, 4, 1.1, 0.8, 1.2, 4, 0});
  expect_edges(level_edges(noisy, {.threshold = 1}), {1 / 1.2, 1 + 2.0 / 3, 2.25, 5 + 1.0 / 3, 6.5, 8.75});
  // The contact closes at the last crossing before the level reaches 2, and opens at the last one before it reaches 0.
  expect_edges(level_edges(noisy, {.threshold = 1, .hysteresis = 2}), {2.25, 8.75});
}

TEST(LevelEdges, ShortStatesAreMerged) {
  const Trace bounces = trace({0, 2, 2, 2, 0, 2, 2, 0, 0, 0, 2, 0, 0, 0});
  expect_edges(level_edges(bounces, {.threshold = 1}), {0.5, 3.5, 4.5, 6.5, 9.5, 10.5});
  expect_edges(level_edges(bounces, {.threshold = 1, .merge = 2}), {0.5, 6.5});
}

TEST(LevelEdges, ATraceThatBeginsClosedSaysSoAtItsFirstRow) {
  expect_edges(level_edges(trace({5, 5, 0}), {.threshold = 1}), {0, 1.8});
  expect_edges(level_edges(trace({0, 0}), {.threshold = 1}), {});
}

}  // namespace
}  // namespace softland
