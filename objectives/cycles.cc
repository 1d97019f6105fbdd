#include "objectives/cycles.h"

#include <algorithm>
#include <cmath>

namespace softland {

CycleRecorder::CycleRecorder(double contact_gap, const MetricsOptions& options, const CycleTimes& times)
    : contact_gap_(contact_gap), open_position_(options.opening.open_position), times_(times) {
  for (std::size_t n = 0; n < times.cycles; ++n) {
    MetricsOptions own = options;
    own.opening.time = times.command(n);
    cycles_.push_back({.metrics = MetricsObserver(contact_gap, own)});
  }
  cycles_.front().began_open = true;
}

// Adds a point of the motion to the current cycle; a point at the boundary of two cycles belongs to both.
void CycleRecorder::knot(const TrajectoryPoint& point) {
  if (current_ == cycles_.size()) return;
  cycles_[current_].metrics.knot(point);
  constexpr double last_part = 1.0 / 3;  // final share of a cycle's open phase, in which CycleFigures::swing is measured
  if (times_.begin(current_ + 1) - point.time <= last_part * (times_.period - times_.on_time)) {
    double& swing = cycles_[current_].swing;
    swing = std::max(swing, std::abs(point.position - open_position_));
  }
  if (point.time < times_.begin(current_ + 1)) return;
  if (++current_ == cycles_.size()) return;
  cycles_[current_].began_open = point.position < contact_gap_;
  cycles_[current_].metrics.knot(point);
}

void CycleRecorder::touch(const Touch& touch) {
  const auto cycle = static_cast<std::size_t>(touch.begin / times_.period);
  if (cycle < cycles_.size()) cycles_[cycle].metrics.touch(touch);
}

// Adds a time span in which the connection is closed to every cycle over which the span extends.
void CycleRecorder::state(std::optional<std::size_t> contact, bool is_closed, double time) {
  if (contact) return;
  for (std::size_t n = 0; closed_from_ && n < cycles_.size(); ++n) cycles_[n].on_time += closed_in(n, time);
  closed_from_ = is_closed ? std::optional(time) : std::nullopt;
}

double CycleRecorder::closed_in(std::size_t cycle, double until) const {
  return std::max(0.0, std::min(until, times_.begin(cycle + 1)) - std::max(*closed_from_, times_.begin(cycle)));
}

void CycleRecorder::energies(double time, const EnergyBalance& balance) {
  if (counted_ == cycles_.size() || time < times_.begin(counted_ + 1)) return;
  cycles_[counted_++].source_work = balance.source_work - work_before_;
  work_before_ = balance.source_work;
}

CycleFigures CycleRecorder::figures(std::size_t cycle, const Trajectory& run) {
  Cycle& own = cycles_[cycle];
  Trajectory alone = run;
  alone.status = Status::done;
  alone.contacts.clear();
  alone.force = {};
  alone.energy.source_work =
      std::isnan(own.source_work) && counted_ == cycle ? run.energy.source_work - work_before_ : own.source_work;
  alone.layer_energy = 0;
  CycleFigures f{.metrics = own.metrics.metrics(alone)};
  const double begin = times_.begin(cycle);
  for (double Metrics::*const time : {&Metrics::initial_contact_time, &Metrics::permanent_contact_time,
                                      &Metrics::last_rebound_end, &Metrics::open_command, &Metrics::end})
    f.metrics.*time -= begin;
  f.closes = own.began_open && f.metrics.initial_contact_time < times_.on_time;
  f.opens = std::isfinite(f.metrics.opening_time);
  f.swing = own.swing;
  f.on_time = own.on_time + (closed_from_ ? closed_in(cycle, times_.begin(cycle + 1)) : 0);
  return f;
}

}  // namespace softland
