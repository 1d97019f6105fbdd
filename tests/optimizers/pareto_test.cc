#include "optimizers/pareto.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "base/require.h"

namespace softland {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Returns points with coordinates k / levels, so that many have equal coordinates.
std::vector<Objectives> lattice_points(std::size_t count, std::size_t objectives, std::uint64_t seed, double levels) {
  std::vector<Objectives> points(count);
  std::uint64_t draw = 0;
  for (Objectives& point : points) {
    for (std::size_t i = 0; i < objectives; ++i)
      point.push_back(std::floor(random_uniform(seed, Stream::scene, draw++) * levels) / levels);
  }
  return points;
}

/// Finds the front by its definition: compares every point with every other.
std::vector<std::size_t> front_by_definition(const std::vector<Objectives>& points) {
  std::vector<std::size_t> front;
  for (std::size_t k = 0; k < points.size(); ++k) {
    bool stands = true;
    for (std::size_t other = 0; other < points.size(); ++other) {
      bool nowhere_worse = true, somewhere_better = false;
      for (std::size_t i = 0; i < points[k].size(); ++i) {
        nowhere_worse = nowhere_worse && points[other][i] <= points[k][i];
        somewhere_better = somewhere_better || points[other][i] < points[k][i];
      }
      if (nowhere_worse && (somewhere_better || other < k)) stands = false;
    }
    if (stands) front.push_back(k);
  }
  return front;
}

/// Counts the cells of the lattice whose lower corner is dominated by a point.
double volume_by_cells(const std::vector<Objectives>& points, std::size_t objectives, int levels) {
  long covered = 0, cells = 1;
  for (std::size_t i = 0; i < objectives; ++i) cells *= levels;
  for (long cell = 0; cell < cells; ++cell) {
    Objectives corner;
    for (long rest = cell, i = 0; i < static_cast<long>(objectives); ++i, rest /= levels)
      corner.push_back(static_cast<double>(rest % levels) / levels);
    covered += std::any_of(points.begin(), points.end(), [&](const Objectives& point) {
      for (std::size_t i = 0; i < objectives; ++i) {
        if (point[i] > corner[i] + 1e-9) return false;  // the distance of lattice points is much larger
      }
      return true;
    });
  }
  return static_cast<double>(covered) / static_cast<double>(cells);
}

TEST(ParetoFront, IsWhatNoPointDominates) {
  for (const std::size_t objectives : {1u, 2u, 3u, 5u}) {
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
      const auto points = lattice_points(150, objectives, seed, seed % 2 == 0 ? 8 : 1000);
      EXPECT_EQ(pareto_front(points), front_by_definition(points)) << objectives << " " << seed;
    }
  }
}

TEST(ParetoFront, HasNoPointThatIsNotFinite) {
  const std::vector<Objectives> points{{nan, 0}, {1, 1}, {0, std::numeric_limits<double>::infinity()}, {2, 0}};
  EXPECT_EQ(pareto_front(points), (std::vector<std::size_t>{1, 3}));
  EXPECT_TRUE(pareto_front({}).empty());
}

TEST(ParetoFront, RefusesPointsOfDifferentLengths) {
  const std::vector<Objectives> points{{1, 2}, {1}};
  EXPECT_THROW(static_cast<void>(pareto_front(points)), InvalidInput);
  EXPECT_THROW(static_cast<void>(hypervolume(points, Objectives{3, 3})), InvalidInput);
}

TEST(Hypervolume, IsTheNumberOfCellsThatAreDominated) {
  constexpr int kLevels = 12;
  for (const std::size_t objectives : {1u, 2u, 3u}) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const auto points = lattice_points(seed % 3 == 0 ? 200 : 9, objectives, seed, kLevels);
      EXPECT_NEAR(hypervolume(points, Objectives(objectives, 1.0)), volume_by_cells(points, objectives, kLevels), 1e-12)
          << objectives << " " << seed;
    }
  }
}

TEST(Hypervolume, IsABoxForOnePointAndNothingForNone) {
  EXPECT_EQ(hypervolume(std::vector<Objectives>{{1, 2, 3}}, Objectives{2, 4, 6}), 6);
  EXPECT_EQ(hypervolume({}, Objectives{2, 4}), 0);
  EXPECT_EQ(hypervolume(std::vector<Objectives>{{2, 0}, {3, -9}, {nan, 0}}, Objectives{2, 4}), 0) << "nothing lies below it";
}

TEST(Hypervolume, OfAFrontIsThatOfAllPoints) {
  const auto points = lattice_points(300, 3, 5, 1000);
  std::vector<Objectives> front;
  for (const std::size_t k : pareto_front(points)) front.push_back(points[k]);
  EXPECT_NEAR(hypervolume(front, Objectives(3, 1.1)), hypervolume(points, Objectives(3, 1.1)), 1e-12);
}

TEST(Hypervolume, RefusesFourObjectivesAndAReferenceThatIsNotFinite) {
  EXPECT_THROW(static_cast<void>(hypervolume({}, Objectives(4, 1.0))), InvalidInput);
  EXPECT_THROW(static_cast<void>(hypervolume({}, Objectives{1, nan})), InvalidInput);
}

TEST(Knee, IsWhereTheFrontIsFarthestFromTheLineOfItsEnds) {
  // The hyperbola y = 1 / x from (1/4, 4) to (4, 1/4): by symmetry its knee is at (1, 1), in any units.
  std::vector<Objectives> front;
  for (int k = -20; k <= 20; ++k) front.push_back({1e-6 * std::pow(4, k / 20.0), 5e3 * std::pow(4, -k / 20.0)});
  EXPECT_EQ(pareto_knee(front), 20u);
}

TEST(Knee, IsNowhereOnAFrontThatIsStraightOrBulgesOutwards) {
  std::vector<Objectives> straight, bulging;
  for (int k = 0; k <= 10; ++k) {
    straight.push_back({k / 10.0, 1 - k / 10.0});
    bulging.push_back({std::sin(0.157 * k), std::cos(0.157 * k)});
  }
  EXPECT_EQ(pareto_knee(straight), std::nullopt);
  EXPECT_EQ(pareto_knee(bulging), std::nullopt);
  EXPECT_EQ(pareto_knee({}), std::nullopt);
  EXPECT_EQ(pareto_knee(std::vector<Objectives>{{1, 2}, {1, 3}}), std::nullopt) << "they agree in an objective";
}

}  // namespace
}  // namespace softland
