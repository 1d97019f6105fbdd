#include "sampling/classes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/random.h"
#include "base/require.h"

namespace softland {
namespace {

constexpr std::size_t starts = 8;
constexpr int most_iterations = 200;

double square_distance(const SpacePoint& a, const SpacePoint& b) {
  const double dx = a[0] - b[0], dy = a[1] - b[1], dz = a[2] - b[2];
  return dx * dx + dy * dy + dz * dz;
}

// Draws the start centres of the classes from the points, as k-means++ does; fewer than `count` if there are fewer distinct
// points.
std::vector<SpacePoint> start_centres(std::span<const SpacePoint> points, std::size_t count, std::uint64_t seed,
                                      std::size_t start) {
  std::vector<SpacePoint> centres;
  std::vector<double> square(points.size(), 1.0);  // probabilities of the points for the draw of a centre, up to a factor
  while (centres.size() < count) {
    double sum = 0;
    for (const double one : square) sum += one;
    if (!(sum > 0)) break;
    double left = sum * random_uniform(seed, Stream::classes, (start << 32) + centres.size());
    std::size_t chosen = points.size();
    for (std::size_t i = 0; i < points.size() && left >= 0; ++i) {
      if (square[i] > 0) chosen = i;
      left -= square[i];
    }
    centres.push_back(points[chosen]);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double own = square_distance(points[i], centres.back());
      square[i] = centres.size() == 1 ? own : std::min(square[i], own);
    }
  }
  return centres;
}

struct Sorted {
  Classes classes;
  // Sum of the squared distances of the points from the centres of their classes.
  double square = std::numeric_limits<double>::infinity();
};

// Lloyd's iteration: assigns every point to its nearest centre and moves each centre to the mean of its points, until no point
// changes its class.
Sorted settle(std::span<const SpacePoint> points, std::vector<SpacePoint> centres) {
  Sorted sorted{.classes = {.centres = std::move(centres), .shares = {}}};
  std::vector<std::size_t> own(points.size(), points.size());
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    bool moved = false;
    sorted.square = 0;
    std::vector<SpacePoint> sums(sorted.classes.centres.size());
    std::vector<double> counts(sums.size(), 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t c = sorted.classes.nearest(points[i]);
      moved = moved || own[i] != c;
      own[i] = c;
      for (std::size_t axis = 0; axis < 3; ++axis) sums[c][axis] += points[i][axis];
      counts[c] += 1;
      sorted.square += square_distance(points[i], sorted.classes.centres[c]);
    }
    sorted.classes.shares = counts;
    for (double& share : sorted.classes.shares) share /= static_cast<double>(points.size());
    if (!moved) break;
    for (std::size_t c = 0; c < sums.size(); ++c) {
      if (!(counts[c] > 0)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) sorted.classes.centres[c][axis] = sums[c][axis] / counts[c];
    }
  }
  return sorted;
}

}  // namespace

bool is_finite(const SpacePoint& point) {
  return std::ranges::all_of(point, [](double x) { return std::isfinite(x); });
}

std::size_t Classes::nearest(const SpacePoint& point) const {
  std::size_t best = 0;
  for (std::size_t c = 1; c < centres.size(); ++c) {
    if (square_distance(point, centres[c]) < square_distance(point, centres[best])) best = c;
  }
  return best;
}

Classes classes_of(std::span<const SpacePoint> points, std::size_t count, std::uint64_t seed) {
  require(count > 0, "the number of classes must be at least 1");
  require(!points.empty() && std::all_of(points.begin(), points.end(), [](const SpacePoint& p) { return is_finite(p); }),
          "classes need at least one point, and all points must be finite");
  Sorted best;
  for (std::size_t start = 0; start < starts; ++start) {
    Sorted one = settle(points, start_centres(points, count, seed, start));
    if (one.square < best.square) best = std::move(one);
  }
  std::sort(best.classes.centres.begin(), best.classes.centres.end());
  // Repeat the iteration with the centres in ascending order, so that each point's memberships are in the same order.
  return settle(points, std::move(best.classes.centres)).classes;
}

}  // namespace softland
