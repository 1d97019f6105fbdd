#include "objectives/metrics.h"

#include <algorithm>
#include <cmath>

namespace softland {

std::vector<Rebound> rebounds(const Trajectory& trajectory) {
  std::vector<Rebound> all;
  ReboundFinder finder(trajectory.contact_gap);
  for (const TrajectoryPoint& point : trajectory.points) {
    if (!finder.knot(point, [&](const Rebound& r) { all.push_back(r); })) break;
  }
  if (finder.under_way()) all.push_back(*finder.under_way());
  return all;
}

Metrics metrics(const Trajectory& trajectory, const MetricsOptions& options) {
  Metrics result;
  result.status = trajectory.status;
  const bool ran_to_the_end =
      trajectory.status == Status::done || trajectory.status == Status::no_contact || trajectory.status == Status::not_settled;
  double highest = 0, last_end = Metrics::unset;
  int significant = 0;
  const auto take = [&](const Rebound& rebound) {
    highest = std::max(highest, rebound.height);
    if (!(rebound.height > options.significant_rebound)) return;
    ++significant;
    last_end = rebound.end;
  };
  ReboundFinder finder(trajectory.contact_gap);
  for (const TrajectoryPoint& point : trajectory.points) {
    if (!finder.knot(point, take)) break;
  }
  const bool sound = finder.usable(), under_way = finder.under_way().has_value();
  if (under_way) take(*finder.under_way());
  if (ran_to_the_end && !sound) result.status = Status::numerical_failure;

  const bool touched = finder.touched();
  result.initial_contact_time = finder.first_touch();
  result.impact_velocity = finder.impact_velocity();
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

  result.major_bounce_height = highest;
  result.bounce_count = significant;
  const double permanent = significant > 0 ? last_end : result.initial_contact_time;
  const double rest = finder.last_time() - permanent;
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
