#include "objectives/cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace softland {
namespace {

// A step that lands softly by itself must not turn the ratios into infinities.
double ratio(double value, double of_step) { return of_step > 0 ? value / of_step : value > 0 ? 1 : 0; }

}  // namespace

void CostObserver::knot(const TrajectoryPoint& point) {
  if (!figures_.touched) figures_.closest = std::min(figures_.closest, contact_gap_ - point.position);
  rebounds_.knot(point, [this](const Rebound& rebound) { take(rebound, rebound.end); });
}

void CostObserver::touch(const Touch& touch) {
  if (!figures_.touched) figures_.first_touch = figures_.last_rebound_end = touch.begin;
  figures_.touched = true;
  figures_.touch_speed = std::max(figures_.touch_speed, touch.impact_velocity);
  figures_.impact_energy += touch.peak_energy;
}

void CostObserver::take(const Rebound& rebound, double until) {
  separated_ += until - rebound.begin;
  rebound_height_ = std::max(rebound_height_, rebound.height);
  if (rebound.height > significant_rebound_) last_rebound_end_ = until;
}

CostFigures CostObserver::figures(double landing_excess) {
  if (!figures_.touched) return figures_;
  if (rebounds_.under_way()) take(*rebounds_.under_way(), rebounds_.last_time());
  CostFigures f = figures_;
  f.closest = 0;
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
  return observer.figures(trajectory.landing_excess);
}

double cost(Target target, Status status, const CostFigures& f, const CostScale& scale, const MetricsOptions& options) {
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
  switch (target) {
    case Target::bounce:
    case Target::rebound:
    case Target::count:
      return bounce;
    case Target::settling:
      return judged_by(ratio(f.last_rebound_end, scale.step.first_touch));
    case Target::impact:
      return judged_by(v);
    case Target::energy:
      break;
  }
  return judged_by(ratio(f.impact_energy, scale.step.impact_energy));
}

}  // namespace softland
