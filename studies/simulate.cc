#include "studies/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/engineering.h"
#include "studies/watched.h"

namespace softland {
namespace {

// What two runs of one closing differ by. The tighter one is so much nearer to the truth that the difference is the error of the
// other.
Metrics difference(const Metrics& a, const Metrics& b) {
  Metrics d;
  d.initial_contact_time = std::abs(a.initial_contact_time - b.initial_contact_time);
  d.permanent_contact_time = std::abs(a.permanent_contact_time - b.permanent_contact_time);
  d.bounce_time = std::abs(a.bounce_time - b.bounce_time);
  d.bounce_count = std::abs(a.bounce_count - b.bounce_count);
  d.major_bounce_height = std::abs(a.major_bounce_height - b.major_bounce_height);
  d.impact_velocity = std::abs(a.impact_velocity - b.impact_velocity);
  d.peak_contact_force = std::abs(a.peak_contact_force - b.peak_contact_force);
  d.impact_energy = std::abs(a.impact_energy - b.impact_energy);
  d.drive_energy = std::abs(a.drive_energy - b.drive_energy);
  return d;
}

struct Run {
  Trajectory trajectory;
  Metrics metrics;
  double tolerance = 0;
  SwitchOptions quadrature;
};

// The largest relative error of the figures that `accuracy` is about, by a tighter run.
double error(const Run& run, const Run& tighter, const Prepared& prepared) {
  const auto relative = [](double value, double truth, double least) {
    if (std::isnan(value) && std::isnan(truth)) return 0.0;
    const double e = std::abs(value - truth) / std::max(std::abs(truth), least);
    return std::isnan(e) ? std::numeric_limits<double>::infinity() : e;
  };
  const Metrics &a = run.metrics, &b = tighter.metrics;
  return std::max({relative(a.initial_contact_time, b.initial_contact_time, 0), relative(a.impact_velocity, b.impact_velocity, 0),
                   relative(a.major_bounce_height, b.major_bounce_height, prepared.scene.metrics.significant_rebound),
                   relative(a.peak_contact_force, b.peak_contact_force, least_peak_force(prepared))});
}

constexpr double tighter_by = 100, least_tolerance = 1e-13, finer_by = 2, finest = 96;
// Of a fifth-order method 2.5 times the steps are to be expected; what needs this many more is not waited for.
constexpr long most_growth = 10, least_steps = 100;
constexpr double helps = 1.0 / 3;  // a tighter run that leaves more than this of the error does not
constexpr int most_in_vain = 2;    // in a row

}  // namespace

double least_peak_force(const Prepared& prepared) {
  constexpr double share = 0.01;
  return share * 2 * prepared.device.bending_energy() / prepared.scene.device.gap.contact;
}

Closing simulate(const Prepared& prepared, bool estimate_errors, const Watch& watch) {
  const std::vector<Signal> signals = prepared.signals();
  int runs = 0;
  bool interrupted = false;
  const auto run = [&](const Switch& device, double tolerance, const SwitchOptions& quadrature, long max_steps) {
    Run r{.tolerance = tolerance, .quadrature = quadrature};
    const std::string what =
        runs++ == 0 ? "closing" : fmt::format("closing again at tolerance {:.0e}, for its errors", tolerance);
    r.trajectory = simulate_closing(device, signals,
                                    {.duration = prepared.duration,
                                     .tolerance = tolerance,
                                     .max_steps = max_steps,
                                     .stop = watch.stop,
                                     .observer = observer(watch, what, prepared.duration)});
    interrupted = interrupted || r.trajectory.status == Status::interrupted;
    r.metrics = metrics(r.trajectory, prepared.scene.metrics);
    return r;
  };
  const auto tighter_than = [&](const Run& r) {
    const SwitchOptions finer{.points_per_length = std::min(finest, finer_by * r.quadrature.points_per_length)};
    return run(Switch(prepared.scene.device, finer), std::max(least_tolerance, r.tolerance / tighter_by), finer,
               most_growth * (least_steps + r.trajectory.work.steps));
  };
  Run best = run(prepared.device, prepared.tolerance, prepared.quadrature, ClosingOptions{}.max_steps);
  const SimulateOptions& asked = prepared.scene.simulate;
  const bool may_tighten = estimate_errors && asked.tolerance == 0;
  if (may_tighten && best.trajectory.status == Status::numerical_failure) best = tighter_than(best);

  Closing c;
  if (estimate_errors && best.trajectory.status == Status::done) {
    Run tighter = tighter_than(best);
    double e = error(best, tighter, prepared);
    for (int vain = 0; may_tighten && e > asked.accuracy && vain < most_in_vain && tighter.trajectory.status == Status::done &&
                       tighter.tolerance > least_tolerance;) {
      Run next = tighter_than(tighter);
      if (next.trajectory.status != Status::done) break;
      const double less = error(tighter, next, prepared);
      vain = less < helps * e ? 0 : vain + 1;
      e = less;
      best = std::move(tighter);
      tighter = std::move(next);
    }
    c.judge = {.status = tighter.trajectory.status,
               .message = tighter.trajectory.message,
               .metrics = tighter.metrics,
               .tolerance = tighter.tolerance,
               .quadrature = tighter.quadrature};
    if (tighter.trajectory.status == Status::done) {
      c.errors = difference(best.metrics, tighter.metrics);
      if (may_tighten && e > asked.accuracy) {
        c.warnings.push_back(
            fmt::format("accuracy {} is not reached: at an integrator tolerance of {} t_i, v_i, B_H or the peak force is still "
                        "known to {} only, for so small a change decides it",
                        engineering(asked.accuracy, ""), engineering(best.tolerance, "", 1), engineering(e, "", 1)));
      }
      if (c.errors.bounce_count > 0 || c.errors.bounce_time > 0.01 * std::abs(best.metrics.bounce_time)) {
        c.warnings.push_back(
            fmt::format("bounce count and permanent contact time are ill-conditioned here: a hundredfold tighter run gives {} "
                        "rebounds instead of {}; past the first large rebound a closing is chaotic",
                        tighter.metrics.bounce_count, best.metrics.bounce_count));
      }
    }
  }
  c.trajectory = std::move(best.trajectory);
  c.tolerance = best.tolerance;
  c.quadrature = best.quadrature;
  std::vector<double> hold;
  for (const Signal& signal : signals) hold.push_back(signal.hold_level());
  if (const auto closed = closed_equilibrium(prepared.device, hold)) c.trajectory.hold_force = closed->contact_force;
  c.metrics = metrics(c.trajectory, prepared.scene.metrics);
  if (interrupted) {
    const bool complete = c.trajectory.status != Status::interrupted;
    c.metrics.status = Status::interrupted;
    c.errors = {};
    c.judge.reset();
    c.warnings = {complete ? fmt::format("interrupted: the figures are those of a complete closing at tolerance {:.0e}, but how "
                                         "far they are from the truth was not found out",
                                         c.tolerance)
                           : std::string("interrupted: the figures are those of the part of the closing that was simulated")};
  }
  c.warnings.insert(c.warnings.begin(), c.trajectory.warnings.begin(), c.trajectory.warnings.end());
  c.warnings.insert(c.warnings.begin(), prepared.scene.warnings.begin(), prepared.scene.warnings.end());
  const bool piezo_only = prepared.scene.device.electrodes.empty();
  for (std::size_t k = 0; k < signals.size(); ++k) {
    const DriveKind kind = prepared.device.drive_kind(k);
    if (kind == DriveKind::dispersion) continue;  // a force factor is no voltage
    if (kind == DriveKind::electrode || piezo_only) c.peak_voltage = std::max(c.peak_voltage, signals[k].peak(prepared.duration));
    c.peak_slew = std::max(c.peak_slew, signals[k].peak_slew(prepared.duration));
  }
  return c;
}

}  // namespace softland
