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

void LandingFigures::touch(const Touch& touch) {
  touched_ = true;
  touches_.add(touch);
}

void LandingFigures::rebound(const Rebound& rebound) {
  highest_ = std::max(highest_, rebound.height);
  latest_ = rebound;
  if (std::isfinite(rebound.end)) separated_ += rebound.end - rebound.begin;
  if (!(rebound.height > options_.significant_rebound)) return;
  // The duration is NaN for a rebound that has not ended, because its end is NaN.
  if (++significant_ == 1) first_duration_ = rebound.end - rebound.begin;
  last_end_ = rebound.end;
}

LandingFigures::Course MetricsObserver::course() const {
  return {.sound = rebounds_.usable(),
          .above = rebounds_.under_way().has_value(),
          .first_touch = rebounds_.first_touch(),
          .last_time = rebounds_.last_time(),
          .closest = closest_};
}

void MetricsObserver::knot(const TrajectoryPoint& point) {
  if (!rebounds_.first_touch().happened()) closest_ = std::min(closest_, contact_gap_ - point.position);
  if (opening_) opening_->follow(last_, point);
  charge_.follow(last_, point);
  rebounds_.knot(point, [this](const Rebound& rebound) { opening_ ? opening_->bounce(rebound) : figures_.rebound(rebound); });
  last_ = point;
  if (!opening_ && point.time >= options_.opening.time) begin_opening();
}

// A rebound that has not ended at the command to open counts as part of the closing, and later rebounds as part of the opening.
void MetricsObserver::begin_opening() {
  landing_ = course();
  if (landing_->above) figures_.rebound(*rebounds_.under_way());
  opening_.emplace(options_.opening, contact_gap_, options_.significant_rebound);
  make_charge_ = charge_.charge();
}

Metrics MetricsObserver::metrics(const Trajectory& end) {
  if (!opening_) {
    if (rebounds_.under_way()) figures_.rebound(*rebounds_.under_way());
    Metrics result = figures_.metrics(end, course());
    if (result.is_complete() && result.touched()) result.make_charge = charge_.charge();
    return result;
  }
  landing_->sound = rebounds_.usable();
  Metrics result = figures_.metrics(end, *landing_);
  result.asked.opening = true;
  result.asked.break_charge = options_.asked.charge;
  if (result.is_complete()) {
    if (result.touched()) result.make_charge = make_charge_;
    result.break_charge = charge_.charge() - make_charge_;
  }
  result.end = rebounds_.last_time();
  const OpeningOnCommand opening = opening_->figures(rebounds_.under_way(), last_);
  result.open_command = opening.command;
  result.opening_time = opening.opening_time;
  result.release_bounces = opening.bounces;
  result.release_bounce_height = opening.highest_bounce;
  result.release_settling_time = opening.settling_time;
  result.overshoot_open = opening.overshoot;
  result.least_gap_open = opening.least_gap;
  // The time in separation counts as 0 if it is NaN, as for a run that began closed.
  const double apart = std::isfinite(result.separated) ? result.separated : 0;
  result.closed_time = options_.opening.time - landing_->first_touch.time - apart + opening.opening_time - opening.separated;
  return result;
}

Metrics LandingFigures::metrics(const Trajectory& end, const Course& course) const {
  Metrics result;
  result.status = end.status;
  result.asked = options_.asked;
  const bool ran_to_the_end = end.status == Status::done || end.status == Status::no_contact || end.status == Status::not_settled;
  const bool sound = course.sound;
  if (ran_to_the_end && !sound) result.status = Status::numerical_failure;

  const bool is_connection = !end.contacts.empty();
  if (!end.began_closed) {
    const FirstTouch& first = is_connection ? end.first_touch : course.first_touch;
    result.initial_contact_time = first.time;
    result.impact_velocity = first.velocity;
  }
  if (touched_ && !end.began_closed) result.largest_impact_velocity = touches_.impact_velocity;
  if (!ran_to_the_end || !sound) return result;

  result.drive_energy = end.energy.source_work + end.layer_energy;
  result.capacitance = end.hold_capacitance;
  result.end = course.last_time;
  if (end.began_closed) {
    if (end.status == Status::done) result.status = Status::not_settled;
    return result;
  }
  if (!course.first_touch.happened()) {
    result.closest = course.closest;
    if (end.status == Status::done) result.status = result.touched() ? Status::not_settled : Status::no_contact;
    return result;
  }
  if (end.ends_at_touch) return result;  // the run ended at first touch: the figures below need a contact law
  result.hold_force = end.hold_force;
  result.resistance = end.hold_resistance;
  result.electrical_contact = end.electrical.first_closed;
  result.electrical_settling = end.electrical.closed_from;
  result.electrical_bounces = end.electrical.openings;
  if (touched_) {
    result.peak_contact_force = touches_.peak_force;
    result.impact_energy = touches_.peak_energy;
    result.pressure = touches_.pressure;
    static_cast<ForceOutcome&>(result) = end.force;
  }

  result.major_bounce_height = highest_;
  result.first_rebound_time = first_duration_;
  result.bounce_count = significant_;
  result.separated = separated_ + (course.above ? course.last_time - latest_.begin : 0);
  result.reopened = course.above && latest_.height > end.contact_gap / 2;
  if (std::isfinite(end.landing_excess)) result.landing_excess = std::max(0.0, end.landing_excess);
  const double permanent = significant_ > 0 ? last_end_ : course.first_touch.time;
  result.last_rebound_end = std::isnan(permanent) ? course.last_time : permanent;
  const double rest = course.last_time - permanent;
  // A contact is settled when it stays closed for at least one in-contact period. If that period is not known, a closing
  // without a significant rebound counts as settled.
  const bool long_enough = rest >= end.in_contact_period || (result.bounce_count == 0 && std::isnan(end.in_contact_period));
  result.settled = end.status == Status::done && end.is_held && !course.above && long_enough;
  if (!result.settled) {
    if (end.status == Status::done) result.status = Status::not_settled;
    return result;
  }
  result.permanent_contact_time = permanent;
  result.bounce_time = permanent - result.initial_contact_time;
  return result;
}

Metrics metrics(const Trajectory& trajectory, const MetricsOptions& options) {
  MetricsObserver observer(trajectory.contact_gap, options);
  for (const TrajectoryPoint& point : trajectory.points) observer.knot(point);
  for (const Touch& touch : trajectory.touches) observer.touch(touch);
  return observer.metrics(trajectory);
}

}  // namespace softland
