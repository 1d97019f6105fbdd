#include "studies/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

}  // namespace

Closing simulate(const Prepared& prepared, bool estimate_errors, const std::atomic<bool>* stop) {
  const std::vector<Signal> signals = prepared.signals();
  ClosingOptions options{.duration = prepared.duration, .tolerance = prepared.tolerance, .stop = stop};
  Closing c;
  c.trajectory = simulate_closing(prepared.device, signals, options);
  std::vector<double> hold;
  for (const Signal& signal : signals) hold.push_back(signal.hold_level());
  if (const auto closed = closed_equilibrium(prepared.device, hold)) c.trajectory.hold_force = closed->contact_force;
  c.metrics = metrics(c.trajectory, prepared.scene.metrics);
  c.warnings = prepared.scene.warnings;
  c.warnings.insert(c.warnings.end(), c.trajectory.warnings.begin(), c.trajectory.warnings.end());
  const bool piezo_only = prepared.scene.device.electrodes.empty();
  for (std::size_t k = 0; k < signals.size(); ++k) {
    const DriveKind kind = prepared.device.drive_kind(k);
    if (kind == DriveKind::dispersion) continue;  // a force factor is no voltage
    if (kind == DriveKind::electrode || piezo_only) c.peak_voltage = std::max(c.peak_voltage, signals[k].peak(prepared.duration));
    c.peak_slew = std::max(c.peak_slew, signals[k].peak_slew(prepared.duration));
  }
  if (estimate_errors && c.trajectory.status == Status::done) {
    options.tolerance = std::max(1e-13, prepared.tolerance / 100);
    Trajectory tighter = simulate_closing(prepared.device, signals, options);
    if (tighter.status == Status::done) {
      const Metrics better = metrics(tighter, prepared.scene.metrics);
      c.errors = difference(c.metrics, better);
      if (c.errors.bounce_count > 0 || c.errors.bounce_time > 0.01 * std::abs(c.metrics.bounce_time)) {
        c.warnings.push_back(
            fmt::format("bounce count and permanent contact time are ill-conditioned here: a hundredfold tighter run gives {} "
                        "rebounds instead of {}; past the first large rebound a closing is chaotic",
                        better.bounce_count, c.metrics.bounce_count));
      }
    }
  }
  return c;
}

}  // namespace softland
