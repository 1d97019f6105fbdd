#include "studies/search_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/engineering.h"
#include "base/require.h"
#include "model/constants.h"

namespace softland {
namespace {

double hold_level(const Prepared& p, const std::string& drive) {
  const auto found = p.drives.waveforms.find(drive);
  return found == p.drives.waveforms.end() ? 0 : signal(found->second).hold_level();
}

// Voltage whose static effect on the contact point alone is `lift` away from the contact [m].
double lifting_voltage(const Prepared& p, double lift) {
  const Eigen::VectorXd squares = p.model.angular_frequencies().cwiseAbs2();
  const double per_volt = p.model.contact_shape().dot(p.model.piezo_shape().cwiseQuotient(squares));
  return -lift / per_volt;
}

void add_pulse(DriveSearch& s, const Prepared& p, double t0) {
  const double period = 2 * pi / p.model.angular_frequencies()[0];
  s.variables = {{"level_1_V", s.limits.min_voltage, s.limits.max_voltage},
                 {"level_2_V", s.limits.min_voltage, s.limits.max_voltage},
                 {"time_1_s", 0.05 * t0, 1.6 * t0},
                 {"duration_2_s", 0.05 * t0, 1.6 * t0},
                 {"edge_s", 0.005 * period, 0.1 * period}};
  const auto inside = [&](double v) { return std::clamp(v, s.limits.min_voltage, s.limits.max_voltage); };
  if (s.drive == piezo_drive) {
    // Brake late in the flight and let go at touch: lifts of a part of the contact gap.
    const double gap = p.scene.device.gap.contact;
    for (const double brake : {0.3, 0.6}) {
      s.starts.push_back(
          {inside(lifting_voltage(p, 0.1 * gap)), inside(lifting_voltage(p, brake * gap)), 0.9 * t0, 0.7 * t0, 0.05 * period});
    }
  } else if (s.brakes) {
    // Wait, pull back in the second half of the flight, let go at touch.
    for (const double brake : {0.5, 0.8})
      s.starts.push_back({0, inside(brake * s.limits.max_voltage), 0.5 * t0, 0.5 * t0, 0.01 * period});
  } else {
    // Throw, coast on less than the hold level, catch.
    for (const double throwing : {1.0, 1.1}) {
      s.starts.push_back({inside(throwing * s.hold), inside(0.6 * s.hold), 0.85 * t0, 0.5 * t0, 0.01 * period});
    }
  }
}

void add_harmonic(DriveSearch& s, const Prepared& p, double t0) {
  const double room = std::min(s.limits.max_voltage - s.hold, s.hold - s.limits.min_voltage);
  require(room > 0, fmt::format("driver.{}: the hold level {} stands at the driver's limit, which leaves no room for a dither",
                                s.drive, engineering(s.hold, "V", 5)));
  const Eigen::VectorXd& omega = p.model.angular_frequencies();
  const Eigen::Index mode = std::min<Eigen::Index>(s.drive == piezo_drive ? 2 : 1, omega.size() - 1);
  const double upper = omega.size() > 1 ? omega[mode] : 6 * omega[0];
  s.variables = {{"amplitude_V", 0, room},           {"angular_frequency_rad_s", 0.2 * omega[0], upper},
                 {"phase_rad", 0, 2 * pi},           {"start_s", 0, t0},
                 {"duration_s", 0.1 * t0, 2.5 * t0}, {"fade", 0, 0.5}};
  for (const double frequency : {0.15, 0.45}) s.starts.push_back({room / 2, frequency * upper, pi, 0, 1.5 * t0, 0.2});
}

void add_step(DriveSearch& s, const Prepared&, double t0) {
  s.variables = {{"rise_time_s", 0, 2.5 * t0}};
  s.starts = {{0.5 * t0}};
}

/// The families that have parameters to search.
struct SearchedFamily {
  std::string_view name;
  void (*add)(DriveSearch&, const Prepared&, double first_touch);
};
constexpr auto searched_families = std::to_array<SearchedFamily>(
    {{FamilyOf<Step>::name, add_step}, {FamilyOf<Pulse>::name, add_pulse}, {FamilyOf<Harmonic>::name, add_harmonic}});

void add_variables(DriveSearch& s, const Prepared& p, double first_touch) {
  std::vector<std::string_view> known;
  for (const SearchedFamily& family : searched_families) {
    if (family.name == s.family) return family.add(s, p, first_touch);
    known.push_back(family.name);
  }
  throw InvalidInput(fmt::format("--waveform {}: only {} have parameters to search", s.family, fmt::join(known, ", ")));
}

}  // namespace

std::string searched_electrode(const Device& device) {
  require(!device.electrodes.empty(),
          fmt::format("optimize --actuator electrostatic|both needs an electrode, and the scene has none{}",
                      device.dispersion ? "; the factor of a dispersion force is not searched" : ""));
  for (const Electrode& e : device.electrodes) {
    if (e.name == "main" && e.side != Side::far) return e.name;
  }
  const auto pulling =
      std::find_if(device.electrodes.begin(), device.electrodes.end(), [](const Electrode& e) { return e.side != Side::far; });
  require(pulling != device.electrodes.end(),
          "optimize needs an electrode that pulls in, and all of the scene's are on the far side");
  return pulling->name;
}

std::vector<std::string> braking_electrodes(const Prepared& prepared) {
  std::vector<std::string> names;
  for (const Electrode& e : prepared.scene.device.electrodes) {
    if (e.side == Side::far && prepared.drives.limits.contains(e.name)) names.push_back(e.name);
  }
  return names;
}

Waveform DriveSearch::waveform(std::span<const double> x) const {
  const double slew = limits.max_slew;  // infinite where there is no limit
  if (family == FamilyOf<Step>::name) return Step{.level = hold, .rise_time = std::max(x[0], std::abs(hold) / slew)};
  if (family == FamilyOf<Harmonic>::name) {
    // Under a slew limit the sine waits for the base, and fades for as long as its amplitude needs: the slope of the envelope
    // adds to that of the sine. Half the duration is the longest fade; what is too steep even then is made smaller.
    const double omega = x[1], duration = x[4], rise = std::abs(hold) / slew, start = std::max(x[3], rise);
    const double needed = x[0] * omega < slew ? x[0] / (slew - x[0] * omega) : std::numeric_limits<double>::infinity();
    const double fade = std::min(std::max(x[5] * duration, needed), duration / 2);
    const double steepest = omega + (fade > 0 ? 1 / fade : 0);
    return Harmonic{.base = hold,
                    .rise_time = rise,
                    .amplitude = std::min(x[0], slew / steepest),
                    .angular_frequency = omega,
                    .phase = x[2],
                    .start = start,
                    .end = start + duration,
                    .fade = fade};
  }
  const double steps = std::max({std::abs(x[0]), std::abs(x[1] - x[0]), std::abs(hold - x[1])});
  const double edge = std::max(x[4], steps / slew);
  const double first = std::max(x[2], edge);
  return Pulse{.levels = {x[0], x[1], hold}, .times = {first, first + std::max(x[3], edge)}, .edge = edge};
}

std::optional<std::vector<double>> DriveSearch::parameters(const Waveform& waveform) const {
  std::vector<double> x;
  if (softland::family(waveform) != family) return std::nullopt;
  if (const auto* step = std::get_if<Step>(&waveform)) {
    x = {step->rise_time};
  } else if (const auto* pulse = std::get_if<Pulse>(&waveform)) {
    if (pulse->levels.size() != 3) return std::nullopt;
    x = {pulse->levels[0], pulse->levels[1], pulse->times[0], pulse->times[1] - pulse->times[0], pulse->edge};
  } else if (const auto* dither = std::get_if<Harmonic>(&waveform)) {
    const double duration = dither->end - dither->start;
    x = {dither->amplitude, dither->angular_frequency, dither->phase, dither->start, duration, dither->fade / duration};
  }
  constexpr double rounding = 1e-9;  // of the bounds' distance: a scene file writes rounded numbers
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double lower = variables[k].lower, upper = variables[k].upper, inside = std::clamp(x[k], lower, upper);
    if (!(std::abs(x[k] - inside) <= rounding * (upper - lower))) return std::nullopt;
    x[k] = inside;
  }
  return x;
}

SearchSpace::SearchSpace(const Prepared& prepared, Actuator actuator, const std::string& family, double first_touch) {
  const auto add = [&](const std::string& drive, bool brakes) {
    const auto limits = prepared.drives.limits.find(drive);
    require(
        limits != prepared.drives.limits.end(),
        fmt::format("optimize needs [driver.{}] with min_voltage and max_voltage: it never searches an unlimited drive", drive));
    DriveSearch s{.drive = drive,
                  .family = family,
                  .hold = hold_level(prepared, drive),
                  .brakes = brakes,
                  .limits = limits->second,
                  .variables = {},
                  .starts = {}};
    require(s.limits.max_voltage > s.limits.min_voltage,
            fmt::format("driver.{}: max_voltage must exceed min_voltage to search between them", drive));
    add_variables(s, prepared, first_touch);
    drives_.push_back(std::move(s));
  };
  if (actuator != Actuator::pzt) {
    add(searched_electrode(prepared.scene.device), false);
    for (const std::string& name : braking_electrodes(prepared)) add(name, true);
  }
  if (actuator != Actuator::electrostatic) {
    require(prepared.model.has_piezo(), "optimize --actuator pzt|both needs a [piezo] section, and the scene has none");
    add(std::string(piezo_drive), false);
  }
}

std::vector<Variable> SearchSpace::variables() const {
  std::vector<Variable> all;
  for (const DriveSearch& d : drives_) {
    for (const Variable& v : d.variables) all.push_back({d.drive + "." + v.name, v.lower, v.upper});
  }
  return all;
}

std::vector<std::vector<double>> SearchSpace::starts() const {
  std::vector<std::vector<double>> all{{}};
  for (const DriveSearch& d : drives_) {
    std::vector<std::vector<double>> longer;
    for (const auto& head : all) {
      for (const auto& tail : d.starts) {
        longer.push_back(head);
        longer.back().insert(longer.back().end(), tail.begin(), tail.end());
      }
    }
    all = std::move(longer);
  }
  return all;
}

std::map<std::string, Waveform> SearchSpace::waveforms(std::span<const double> x) const {
  std::map<std::string, Waveform> result;
  std::size_t at = 0;
  for (const DriveSearch& d : drives_) {
    result.emplace(d.drive, d.waveform(x.subspan(at, d.variables.size())));
    at += d.variables.size();
  }
  return result;
}

std::optional<std::vector<double>> SearchSpace::parameters(const std::map<std::string, Waveform>& waveforms) const {
  std::vector<double> all;
  for (const DriveSearch& d : drives_) {
    const auto found = waveforms.find(d.drive);
    const auto part = found == waveforms.end() ? std::nullopt : d.parameters(found->second);
    if (!part) return std::nullopt;
    all.insert(all.end(), part->begin(), part->end());
  }
  return all;
}

}  // namespace softland
