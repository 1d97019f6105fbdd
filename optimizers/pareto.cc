#include "optimizers/pareto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "base/require.h"

namespace softland {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

bool is_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

void require_length(std::span<const double> point, std::size_t objectives) {
  require(point.size() == objectives,
          fmt::format("a point has {} objectives; it must have {}, as the others have", point.size(), objectives));
}

/// The part of the plane of two minimised objectives that a set of points dominates, up to the reference point. Its boundary is
/// stored as steps (x, y): from x to the next step, all points above y are dominated.
class Staircase {
 public:
  Staircase(double x_reference, double y_reference) : steps_{{-unbounded, y_reference}, {x_reference, -unbounded}} {}

  /// Adds a point that is below the reference point in both objectives.
  void insert(double x, double y) {
    auto step = std::prev(steps_.upper_bound(x));
    if (step->second <= y) return;
    double left = x, height = step->second;
    for (++step;;) {
      area_ += (step->first - left) * (height - y);
      if (step->second <= y) break;
      left = step->first;
      height = step->second;
      step = steps_.erase(step);
    }
    steps_[x] = y;
  }

  [[nodiscard]] double area() const { return area_; }

 private:
  std::map<double, double> steps_;
  double area_ = 0;
};

double volume(const std::vector<const Objectives*>& points, std::span<const double> reference) {
  if (reference.size() == 1) return points.empty() ? 0 : reference[0] - (*points.front())[0];
  Staircase dominated(reference[0], reference[1]);
  double total = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    dominated.insert((*points[k])[0], (*points[k])[1]);
    if (reference.size() == 2) continue;
    const double next = k + 1 < points.size() ? (*points[k + 1])[2] : reference[2];
    total += dominated.area() * (next - (*points[k])[2]);
  }
  return reference.size() == 2 ? dominated.area() : total;
}

}  // namespace

bool dominates(std::span<const double> a, std::span<const double> b) {
  require_length(b, a.size());
  bool better = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(a[i] <= b[i])) return false;
    better = better || a[i] < b[i];
  }
  return better;
}

std::vector<std::size_t> pareto_front(std::span<const Objectives> points) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < points.size(); ++k) {
    require_length(points[k], points.front().size());
    if (is_finite(points[k])) order.push_back(k);
  }
  // In lexicographic order no point dominates an earlier point.
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return points[a] < points[b]; });
  std::vector<std::size_t> front;
  for (const std::size_t k : order) {
    const auto covers = [&](std::size_t other) { return points[other] == points[k] || dominates(points[other], points[k]); };
    // Compare with the last points of the Pareto front first: they are the nearest to point k, and most likely dominate it.
    if (std::none_of(front.rbegin(), front.rend(), covers)) front.push_back(k);
  }
  std::sort(front.begin(), front.end());
  return front;
}

double hypervolume(std::span<const Objectives> points, std::span<const double> reference) {
  require(!reference.empty() && reference.size() <= 3,
          fmt::format("a hypervolume needs one to three objectives, not {}", reference.size()));
  require(is_finite(reference), "the reference of a hypervolume must be finite");
  std::vector<const Objectives*> below;
  for (const Objectives& point : points) {
    require_length(point, reference.size());
    if (is_finite(point) && std::equal(point.begin(), point.end(), reference.begin(), std::less<>())) below.push_back(&point);
  }
  std::stable_sort(below.begin(), below.end(), [](const auto* a, const auto* b) { return a->back() < b->back(); });
  return volume(below, reference);
}

std::vector<ObjectiveRange> objective_ranges(std::span<const Objectives> points) {
  std::vector<ObjectiveRange> ranges;
  for (const Objectives& point : points) {
    if (ranges.empty()) ranges.assign(point.size(), {unbounded, -unbounded});
    require_length(point, ranges.size());
    for (std::size_t i = 0; i < point.size(); ++i) {
      ranges[i].lowest = std::min(ranges[i].lowest, point[i]);
      ranges[i].highest = std::max(ranges[i].highest, point[i]);
    }
  }
  return ranges;
}

std::optional<std::size_t> pareto_knee(std::span<const Objectives> front) {
  constexpr double rounding = 1e-12;
  const std::vector<ObjectiveRange> ranges = objective_ranges(front);
  std::optional<std::size_t> knee;
  double least = 1 - rounding;
  for (std::size_t k = 0; k < front.size(); ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const double width = ranges[i].highest - ranges[i].lowest;
      if (!(width > 0 && std::isfinite(width))) return std::nullopt;
      sum += (front[k][i] - ranges[i].lowest) / width;
    }
    if (sum < least) {
      least = sum;
      knee = k;
    }
  }
  return knee;
}

}  // namespace softland
