#include "studies/search/searched_trains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/constants.h"
#include "studies/search/searched_families.h"
#include "studies/search/searched_shapes.h"

namespace softland::internal {
namespace {

std::size_t pulses_of(const DriveSearch& s) { return s.family->train.pulses > 0 ? s.family->train.pulses : s.count; }

std::size_t pauses_of(const DriveSearch& s) {
  const std::size_t pulses = pulses_of(s);
  return !s.family->train.coasts ? 0 : s.brakes ? pulses : std::max<std::size_t>(pulses - 1, 1);
}

void add_variables(DriveSearch& s, const PreparedScene& p, double t0) {
  const TrainRules& rules = s.family->train;
  const std::size_t pulses = pulses_of(s);
  const double period = first_period(p);
  for (std::size_t k = 1; k <= pulses; ++k)
    s.variables.push_back({fmt::format("level_{}_V", k), s.limits.min_voltage, s.limits.max_voltage});
  for (std::size_t k = 1; k <= pulses; ++k) {
    s.variables.push_back({k == 1 ? std::string(rules.first_duration) : fmt::format("duration_{}_s", k), 0.05 * t0,
                           rules.longest[std::min(k, rules.longest.size()) - 1] * t0});
  }
  for (std::size_t k = 1; k <= pauses_of(s); ++k) s.variables.push_back({fmt::format("coast_{}_s", k), 0.05 * t0, 1.6 * t0});
  s.variables.push_back({"edge_s", 0.005 * period, rules.longest_edge * period});
}

}  // namespace

Waveform pulse_of(const DriveSearch& s, std::span<const double> levels, std::span<const double> durations, double edge) {
  Pulse pulse{.levels = {levels.begin(), levels.end()}, .times = {}, .edge = edge};
  pulse.levels.push_back(s.hold);
  double steps = std::abs(levels[0] - s.before);
  for (std::size_t k = 0; k < levels.size(); ++k) steps = std::max(steps, std::abs(pulse.levels[k + 1] - pulse.levels[k]));
  pulse.edge = std::max(edge, steps / s.limits.max_slew);
  double time = 0;
  for (const double duration : durations) pulse.times.push_back(time += std::max(duration, pulse.edge));
  return pulse;
}

void add_pulse(DriveSearch& s, const PreparedScene& p, double t0) {
  const double period = first_period(p);
  add_variables(s, p, t0);
  if (s.drive == piezo_drive) {
    // Starting waveform of a piezo: it lifts the contact point by a share of the contact gap late in the motion, and returns at
    // first contact.
    const double gap = p.scene.device.contact_gap();
    for (const double brake : {0.3, 0.6}) {
      s.starts.push_back({inside(s, lifting_voltage(p, 0.1 * gap)), inside(s, lifting_voltage(p, brake * gap)), 0.9 * t0,
                          0.7 * t0, 0.05 * period});
    }
  } else if (s.brakes) {
    // Starting waveform of an electrode on the far side (away from the contact), which brakes: it waits, pulls back in the
    // second half of the motion, and returns to 0 V at first contact.
    for (const double brake : {0.5, 0.8})
      s.starts.push_back({0, inside(s, brake * s.limits.max_voltage), 0.5 * t0, 0.5 * t0, 0.01 * period});
  } else {
    // Starting waveform of an electrode: it pulls, coasts below the hold level, and then stays at its hold level.
    for (const double throwing : {1.0, 1.1}) {
      s.starts.push_back({inside(s, throwing * s.hold), inside(s, 0.6 * s.hold), 0.85 * t0, 0.5 * t0, 0.01 * period});
    }
  }
  if (const auto landing = throw_and_coast(s, p))
    s.starts.push_back({landing->pulling, landing->coasting, landing->driven_time, landing->coasting_time, 0.005 * period});
}

void add_catch(DriveSearch& s, const PreparedScene& p, double t0) {
  const double period = first_period(p), low = s.limits.min_voltage, high = s.limits.max_voltage;
  add_variables(s, p, t0);
  if (s.drive == piezo_drive) {
    const double gap = p.scene.device.contact_gap();
    for (const double brake : {0.3, 0.6})
      s.starts.push_back({inside(s, lifting_voltage(p, -0.2 * gap)), inside(s, lifting_voltage(p, brake * gap)), inside(s, 0),
                          0.9 * t0, 0.7 * t0, t0, 0.05 * period});
    s.starts.push_back({inside(s, 0), inside(s, 0), inside(s, 0), t0, t0, t0, 0.05 * period});
  } else {
    s.starts.push_back({high, low, high, 0.8 * t0, 0.5 * t0, 1.7 * t0, 0.01 * period});
    s.starts.push_back({inside(s, s.hold), inside(s, 0.6 * s.hold), inside(s, s.hold), 0.85 * t0, 0.5 * t0, t0, 0.01 * period});
    if (const auto landing = throw_and_coast(s, p)) {
      for (const double push : pushes)
        s.starts.push_back(
            {landing->pulling, landing->coasting, high, landing->driven_time, landing->coasting_time, push * t0, 0.005 * period});
    }
  }
}

void add_staircase(DriveSearch& s, const PreparedScene& p, double t0) {
  const double period = first_period(p);
  add_variables(s, p, t0);
  const auto climb = [&](double from, double to, double duration, double edge) {
    std::vector<double> x;
    for (std::size_t k = 0; k < s.count; ++k)
      x.push_back(inside(s, from + (to - from) * static_cast<double>(k) / static_cast<double>(s.count)));
    x.insert(x.end(), s.count, duration * t0);
    x.push_back(std::clamp(duration * t0, 0.005 * period, edge * period));
    s.starts.push_back(x);
  };
  if (s.drive == piezo_drive) {
    const double gap = p.scene.device.contact_gap();
    climb(0, 0, 0.5, 0.05);
    climb(lifting_voltage(p, -0.3 * gap), lifting_voltage(p, 0.3 * gap), 0.5, 0.05);
  } else {
    climb(0.7 * s.hold, 0.95 * s.hold, 6.0 / static_cast<double>(s.count), 0.2);
    climb(0.75 * s.hold, s.hold, 2.0 / static_cast<double>(s.count), 0.05);
  }
}

void add_coast(DriveSearch& s, const PreparedScene& p, double t0) {
  const double period = first_period(p);
  add_variables(s, p, t0);
  if (s.drive == piezo_drive) {
    for (const double brake : {0.3, 0.6})
      s.starts.push_back(
          {inside(s, lifting_voltage(p, brake * p.scene.device.contact_gap())), 1.4 * t0, 0.5 * t0, 0.05 * period});
  } else if (s.brakes) {
    for (const double brake : {0.5, 0.8})
      s.starts.push_back({inside(s, brake * s.limits.max_voltage), 0.5 * t0, 0.5 * t0, 0.01 * period});
  } else {
    for (const double throwing : {1.0, 1.1})
      s.starts.push_back({inside(s, throwing * s.hold), 0.7 * t0, 0.4 * t0, 0.01 * period});
  }
  if (const auto landing = throw_and_coast(s, p))
    s.starts.push_back({landing->pulling, landing->driven_time, landing->coasting_time, 0.005 * period});
}

void add_pulses(DriveSearch& s, const PreparedScene& p, double t0) {
  const double period = first_period(p);
  const std::size_t later = pulses_of(s) - 1, pauses = pauses_of(s);
  add_variables(s, p, t0);
  const auto start = [&](double first, double level, double duration, double second, double pause, double edge) {
    std::vector<double> x{inside(s, first)};
    x.insert(x.end(), later, inside(s, level));
    x.push_back(duration);
    x.insert(x.end(), later, second);
    x.push_back(std::max(pause, edge * period));
    x.insert(x.end(), pauses - 1, s.brakes ? t0 : std::max(0.05 * t0, edge * period));
    x.push_back(edge * period);
    s.starts.push_back(x);
  };
  if (s.drive == piezo_drive) {
    const double gap = p.scene.device.contact_gap();
    for (const double brake : {0.3, 0.6})
      start(lifting_voltage(p, -0.2 * gap), lifting_voltage(p, brake * gap), 0.8 * t0, 0.7 * t0, 0.05 * t0, 0.05);
  } else if (s.brakes) {
    for (const double brake : {0.5, 0.8}) start(brake * s.limits.max_voltage, 0, 0.5 * t0, 0.5 * t0, 0.5 * t0, 0.01);
  } else {
    const double high = s.limits.max_voltage;
    start(high, high, 0.7 * t0, 1.7 * t0, 0.45 * t0, 0.01);
    start(s.hold, s.hold, 0.85 * t0, t0, 0.4 * t0, 0.01);
    if (const auto landing = throw_and_coast(s, p)) {
      for (const double push : pushes)
        start(landing->pulling, high, landing->driven_time, push * t0, landing->coasting_time, 0.005);
    }
  }
}

Waveform train_at(const DriveSearch& s, std::span<const double> x) {
  const std::size_t pulses = pulses_of(s), pauses = pauses_of(s);
  const double none = inside(s, 0);
  std::vector<double> levels, durations;
  const auto add = [&](double level, double duration) { levels.push_back(level), durations.push_back(duration); };
  for (std::size_t k = 0; k < pulses; ++k) {
    const bool has_pause = k < pauses;
    if (has_pause && s.brakes) add(none, x[2 * pulses + k]);
    add(x[k], x[pulses + k]);
    if (has_pause && !s.brakes) add(none, x[2 * pulses + k]);
  }
  return pulse_of(s, levels, durations, x.back());
}

Parameters of_train(const DriveSearch& s, const Waveform& waveform) {
  const auto& pulse = std::get<Pulse>(waveform);
  const std::size_t pauses = pauses_of(s);
  if (pulse.times.size() != pulses_of(s) + pauses) return std::nullopt;
  std::vector<double> levels, durations, between;
  double before = 0;
  for (std::size_t i = 0; i < pulse.times.size(); ++i) {
    const double duration = pulse.times[i] - before;
    before = pulse.times[i];
    const bool is_pause = pauses > 0 && (i % 2 == 1) != s.brakes;
    if (is_pause && pulse.levels[i] != inside(s, 0)) return std::nullopt;
    if (!is_pause) levels.push_back(pulse.levels[i]);
    (is_pause ? between : durations).push_back(duration);
  }
  std::vector<double> x = levels;
  x.insert(x.end(), durations.begin(), durations.end());
  x.insert(x.end(), between.begin(), between.end());
  x.push_back(pulse.edge);
  return x;
}

}  // namespace softland::internal
