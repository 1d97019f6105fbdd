#include "objectives/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/require.h"

namespace softland {
namespace {

// A step that lands softly by itself must not turn the ratios into infinities.
double ratio(double value, double of_step) { return of_step > 0 ? value / of_step : value > 0 ? 1 : 0; }

}  // namespace

Aim::Aim(std::vector<Part> parts) : parts_(std::move(parts)) {
  require(!parts_.empty(), "a search needs a target");
  for (auto part = parts_.begin(); part != parts_.end(); ++part) {
    require(part->weight > 0 && std::isfinite(part->weight),
            fmt::format("the weight of {} is {}; it must be finite and > 0", to_string(part->target), part->weight));
    require(std::none_of(parts_.begin(), part, [&](const Part& other) { return other.target == part->target; }),
            fmt::format("{} stands twice in a sum of targets", to_string(part->target)));
  }
}

bool Aim::is_about(Target target) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) { return part.target == target; });
}

std::string Aim::text() const {
  if (!is_sum()) return std::string(to_string(parts_[0].target));
  std::string text;
  for (const Part& part : parts_) text += fmt::format("{}{} {}", text.empty() ? "" : " + ", part.weight, to_string(part.target));
  return text;
}

void CostObserver::knot(const TrajectoryPoint& point) {
  if (!figures_.touched) figures_.closest = std::min(figures_.closest, contact_gap_ - point.position);
  rebounds_.knot(point, [this](const Rebound& rebound) { take(rebound, rebound.end); });
}

void CostObserver::touch(const Touch& touch) {
  if (!figures_.touched) figures_.first_touch = figures_.last_rebound_end = touch.begin;
  figures_.touched = true;
  figures_.touch_speed = std::max(figures_.touch_speed, touch.impact_velocity);
  figures_.impact_energy += touch.peak_energy;
  if (!(touch.peak_force <= figures_.peak_force)) figures_.peak_force = touch.peak_force;  // keeps what is not a number
}

void CostObserver::take(const Rebound& rebound, double until) {
  separated_ += until - rebound.begin;
  rebound_height_ = std::max(rebound_height_, rebound.height);
  if (rebound.height > significant_rebound_) last_rebound_end_ = until;
}

CostFigures CostObserver::figures(const Trajectory& end) {
  const double landing_excess = end.landing_excess;
  figures_.drive_energy = end.energy.source_work;
  if (!figures_.touched) return figures_;
  CostFigures f = figures_;
  if (const std::optional<Rebound>& open = rebounds_.under_way()) {
    take(*open, rebounds_.last_time());
    f.reopened = open->height > contact_gap_ / 2;
  }
  f.closest = 0;
  f.steady_force_time = std::isfinite(end.steady_force_time) ? end.steady_force_time : rebounds_.last_time();
  f.separated = separated_;
  f.rebound_height = rebound_height_;
  if (std::isfinite(last_rebound_end_)) f.last_rebound_end = last_rebound_end_;
  // A drive that never comes to rest inside the run leaves the energy unmeasured: the other figures must do.
  if (std::isfinite(landing_excess)) f.landing_excess = std::max(0.0, landing_excess);
  return f;
}

CostFigures cost_figures(const Trajectory& trajectory, const MetricsOptions& options) {
  CostObserver observer(trajectory.contact_gap, options);
  for (const TrajectoryPoint& point : trajectory.points) observer.knot(point);
  for (const Touch& touch : trajectory.touches) observer.touch(touch);
  return observer.figures(trajectory);
}

double cost(const Aim& aim, Status status, const CostFigures& f, const CostScale& scale, const MetricsOptions& options) {
  if (status != Status::done) return std::numeric_limits<double>::infinity();
  if (!f.touched) return 10 + f.closest / scale.contact_gap;
  const double h = ratio(f.rebound_height, scale.step.rebound_height);
  const double p = f.rebound_height / (f.rebound_height + 10 * options.significant_rebound);
  const double v = ratio(f.touch_speed, scale.step.touch_speed);
  const double k = ratio(f.landing_excess, scale.step.landing_excess);
  const double s = f.separated / scale.score_window;
  const double t = ratio(f.first_touch, scale.step.first_touch);
  const double late = t + 10 * std::max(0.0, t - scale.free_touch);
  const double bounce = 0.2 * h + 0.15 * v * v + 0.45 * k + 0.1 * s * s + 0.05 * p + 0.02 * late;
  const auto judged_by = [&](double own) {
    if (f.rebound_height > options.significant_rebound / 2) return 1 + (bounce + own) / 2;
    const double ordered = own + bounce / 1000;
    return ordered / (1 + ordered);
  };
  const auto own = [&](Target target) {
    switch (target) {
      case Target::bounce:
      case Target::rebound:
      case Target::count:
        return bounce;
      case Target::settling:
        return ratio(f.last_rebound_end, scale.step.first_touch);
      case Target::impact:
        return v;
      case Target::energy:
        return std::sqrt(ratio(f.impact_energy, scale.step.impact_energy));
      case Target::force:
        return ratio(f.peak_force, scale.step.peak_force);
      case Target::drive:
        return ratio(f.drive_energy, scale.step.drive_energy);
      case Target::steady:
        break;
    }
    return ratio(f.steady_force_time, scale.step.first_touch);
  };
  // What lets go again is no landing, however softly it came: behind all that stay, before what never touches.
  const double reopening = f.reopened ? 5 : 0;
  if (!aim.has_own_cost()) return reopening + bounce;
  const double cost = reopening + judged_by(aim.mean(own));
  return std::isnan(cost) ? std::numeric_limits<double>::infinity() : cost;
}

}  // namespace softland
