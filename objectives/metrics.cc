#include "objectives/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "integrators/quintic.h"
#include "integrators/roots.h"

namespace softland {
namespace {

/// Knots this close to the first-touch plane, relative to the contact gap, are on it: the integrator stops there to rounding.
constexpr double plane_tolerance = 1e-12;

/// True when the control points of the quintic's Bernstein form are in order: a cheap proof that nothing turns between the knots.
bool surely_monotone(const TrajectoryPoint& a, const TrajectoryPoint& b) {
  const double h = b.time - a.time;
  const double from_a = a.velocity * h / 5;
  const double from_b = b.velocity * h / 5;
  const double bend_a = a.acceleration * h * h / 20;
  const double bend_b = b.acceleration * h * h / 20;
  const std::array<double, 5> differences{
      from_a, from_a + bend_a, (b.position - a.position) - 2 * (from_a + from_b) + bend_b - bend_a, from_b - bend_b, from_b};
  return std::all_of(differences.begin(), differences.end(), [](double d) { return d >= 0; }) ||
         std::all_of(differences.begin(), differences.end(), [](double d) { return d <= 0; });
}

/// A place on the trajectory between which and the next one the separation is monotone and keeps its sign.
struct Node {
  double time = 0;        ///< [s]
  double separation = 0;  ///< [m], 0 on the plane
  double velocity = 0;    ///< [m/s]
};

/// The trajectory as far as its knots are finite and ordered.
std::size_t usable_points(const Trajectory& trajectory) {
  if (!std::isfinite(trajectory.contact_gap)) return 0;
  std::size_t count = 0;
  for (const TrajectoryPoint& point : trajectory.points) {
    if (!(std::isfinite(point.time) && std::isfinite(point.position) && std::isfinite(point.velocity) &&
          std::isfinite(point.acceleration))) {
      break;
    }
    if (count > 0 && point.time < trajectory.points[count - 1].time) break;
    ++count;
  }
  return count;
}

/// Knots, turning points and crossings of the plane, in order. At every change of side there is a node with separation 0.
std::vector<Node> nodes(const Trajectory& trajectory) {
  const double gap = trajectory.contact_gap;
  const double tolerance = plane_tolerance * std::abs(gap);
  const auto snapped = [&](double value) { return std::abs(value) <= tolerance ? 0.0 : value; };
  const auto knot = [&](const TrajectoryPoint& point) { return Node{point.time, snapped(gap - point.position), point.velocity}; };

  std::vector<Node> result;
  const std::size_t count = usable_points(trajectory);
  if (count == 0) return result;
  result.reserve(2 * count);
  result.push_back(knot(trajectory.points.front()));
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const TrajectoryPoint& a = trajectory.points[i];
    const TrajectoryPoint& b = trajectory.points[i + 1];
    if (b.time > a.time) {
      const Quintic curve(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration);
      const auto separation = [&](double t) { return gap - curve.position(t); };
      const auto advance = [&](const Node& node) {
        const Node& before = result.back();
        if ((before.separation < 0 && node.separation > 0) || (before.separation > 0 && node.separation < 0)) {
          const double crossing = bracketed_zero(separation, before.time, node.time);
          result.push_back({crossing, 0, curve.velocity(crossing)});
        }
        result.push_back(node);
      };
      if (!surely_monotone(a, b)) {
        for (const double t : curve.turns()) advance({t, snapped(separation(t)), curve.velocity(t)});
      }
      advance(knot(b));
    } else {
      result.push_back(knot(b));
    }
  }
  return result;
}

/// The first node in contact, or the number of nodes.
std::size_t first_touch(const std::vector<Node>& path) {
  const auto found = std::find_if(path.begin(), path.end(), [](const Node& node) { return node.separation <= 0; });
  return static_cast<std::size_t>(found - path.begin());
}

std::vector<Rebound> rebounds(const std::vector<Node>& path) {
  std::vector<Rebound> result;
  for (std::size_t i = first_touch(path); i < path.size(); ++i) {
    if (!(path[i].separation > 0)) continue;
    Rebound rebound{.begin = path[i - 1].time, .end = Metrics::unset};
    for (; i < path.size() && path[i].separation > 0; ++i) {
      if (path[i].separation > rebound.height) {
        rebound.height = path[i].separation;
        rebound.time_of_height = path[i].time;
      }
    }
    if (i < path.size()) rebound.end = path[i].time;
    result.push_back(rebound);
  }
  return result;
}

}  // namespace

std::vector<Rebound> rebounds(const Trajectory& trajectory) { return rebounds(nodes(trajectory)); }

Metrics metrics(const Trajectory& trajectory, const MetricsOptions& options) {
  Metrics result;
  result.status = trajectory.status;
  const bool ran_to_the_end =
      trajectory.status == Status::done || trajectory.status == Status::no_contact || trajectory.status == Status::not_settled;
  const bool sound = usable_points(trajectory) == trajectory.points.size() && std::isfinite(trajectory.contact_gap);
  if (ran_to_the_end && !sound) result.status = Status::numerical_failure;

  const std::vector<Node> path = nodes(trajectory);
  const std::size_t touch = first_touch(path);
  const bool touched = touch < path.size();
  if (touched) {
    result.initial_contact_time = path[touch].time;
    result.impact_velocity = std::abs(path[touch].velocity);
  }
  if (!ran_to_the_end || !sound) return result;

  result.drive_energy = trajectory.energy.source_work;
  if (!touched) {
    if (trajectory.status == Status::done) result.status = Status::no_contact;
    return result;
  }
  if (trajectory.ends_at_touch) return result;  // what follows depends on a contact that is not described
  result.hold_force = trajectory.hold_force;
  if (!trajectory.touches.empty()) {
    result.peak_contact_force = 0;
    result.impact_energy = 0;
    for (const Touch& one : trajectory.touches) {
      // Not std::max, which would lose a NaN; once NaN it stays.
      if (std::isnan(one.peak_force) || one.peak_force > result.peak_contact_force) result.peak_contact_force = one.peak_force;
      result.impact_energy += one.peak_energy;
    }
  }

  const double window_end = path.back().time;
  double permanent = result.initial_contact_time;
  bool under_way = false;
  result.major_bounce_height = 0;
  for (const Rebound& rebound : rebounds(path)) {
    result.major_bounce_height = std::max(result.major_bounce_height, rebound.height);
    under_way = std::isnan(rebound.end);
    if (!(rebound.height > options.significant_rebound)) continue;
    ++result.bounce_count;
    permanent = rebound.end;
  }
  const double rest = window_end - permanent;
  // A period that nobody knows matters only after a rebound.
  const bool long_enough =
      rest >= trajectory.in_contact_period || (result.bounce_count == 0 && std::isnan(trajectory.in_contact_period));
  result.settled = trajectory.status == Status::done && !under_way && long_enough;
  if (!result.settled) {
    if (trajectory.status == Status::done) result.status = Status::not_settled;
    return result;
  }
  result.permanent_contact_time = permanent;
  result.bounce_time = permanent - result.initial_contact_time;
  return result;
}

}  // namespace softland
