#include "studies/search/searched_families.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/require.h"
#include "model/constants.h"
#include "studies/search/searched_shapes.h"

namespace softland {
namespace {

using internal::first_period, internal::lifting_voltage, internal::Parameters, internal::pulse_of;

void add_pulse(DriveSearch& s, const PreparedScene& p, double t0) {
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
  if (const auto landing = internal::throw_and_coast(s, p))
    s.starts.push_back({landing->pulling, landing->coasting, landing->driven_time, landing->coasting_time, 0.005 * period});
}

void add_harmonic(DriveSearch& s, const PreparedScene& p, double t0) {
  const double upper = internal::add_dither_variables(s, p, t0), room = s.variables[0].upper;
  for (const double frequency : {0.15, 0.45}) s.starts.push_back({room / 2, frequency * upper, pi, 0, 1.5 * t0, 0.2});
}

void add_step(DriveSearch& s, const PreparedScene&, double t0) {
  s.variables = {{"rise_time_s", 0, 2.5 * t0}};
  s.starts = {{0.5 * t0}};
}

// Levels that last for a while each, by edges of one length.
void add_levels(DriveSearch& s, const std::vector<double>& longest, double longest_edge, double t0, double period) {
  const auto numbered = [](const char* what, std::size_t k, const char* unit) {
    return fmt::format("{}_{}{}", what, k + 1, unit);
  };
  for (std::size_t k = 0; k < longest.size(); ++k)
    s.variables.push_back({numbered("level", k, "_V"), s.limits.min_voltage, s.limits.max_voltage});
  for (std::size_t k = 0; k < longest.size(); ++k)
    s.variables.push_back({numbered("duration", k, "_s"), 0.05 * t0, longest[k] * t0});
  s.variables.push_back({"edge_s", 0.005 * period, longest_edge * period});
}

void add_catch(DriveSearch& s, const PreparedScene& p, double t0) {
  const double period = first_period(p), low = s.limits.min_voltage, high = s.limits.max_voltage;
  add_levels(s, {1.6, 1.6, 4}, 0.1, t0, period);
  const auto inside = [&](double v) { return std::clamp(v, low, high); };
  if (s.drive == piezo_drive) {
    const double gap = p.scene.device.gap.contact;
    for (const double brake : {0.3, 0.6})
      s.starts.push_back({inside(lifting_voltage(p, -0.2 * gap)), inside(lifting_voltage(p, brake * gap)), inside(0), 0.9 * t0,
                          0.7 * t0, t0, 0.05 * period});
    s.starts.push_back({inside(0), inside(0), inside(0), t0, t0, t0, 0.05 * period});
  } else {
    // Throw, coast, hold fast.
    s.starts.push_back({high, low, high, 0.8 * t0, 0.5 * t0, 1.7 * t0, 0.01 * period});
    s.starts.push_back({inside(s.hold), inside(0.6 * s.hold), inside(s.hold), 0.85 * t0, 0.5 * t0, t0, 0.01 * period});
    if (const auto landing = internal::throw_and_coast(s, p)) {
      for (const double push : internal::pushes)
        s.starts.push_back(
            {landing->pulling, landing->coasting, high, landing->driven_time, landing->coasting_time, push * t0, 0.005 * period});
    }
  }
}

void add_staircase(DriveSearch& s, const PreparedScene& p, double t0) {
  const double period = first_period(p);
  const auto inside = [&](double v) { return std::clamp(v, s.limits.min_voltage, s.limits.max_voltage); };
  add_levels(s, std::vector<double>(s.count, 3), 1, t0, period);
  const auto climb = [&](double from, double to, double duration, double edge) {
    std::vector<double> x;
    for (std::size_t k = 0; k < s.count; ++k)
      x.push_back(inside(from + (to - from) * static_cast<double>(k) / static_cast<double>(s.count)));
    x.insert(x.end(), s.count, duration * t0);
    x.push_back(edge * period);
    s.starts.push_back(x);
  };
  if (s.drive == piezo_drive) {
    const double gap = p.scene.device.gap.contact;
    climb(0, 0, 0.5, 0.05);
    climb(lifting_voltage(p, -0.3 * gap), lifting_voltage(p, 0.3 * gap), 0.5, 0.05);
  } else {
    climb(0.7 * s.hold, 0.95 * s.hold, 6.0 / static_cast<double>(s.count), 0.2);
    climb(0.75 * s.hold, s.hold, 2.0 / static_cast<double>(s.count), 0.05);
  }
}

// A broken line: the voltages at its knots, the time of the whole and the parts of it between them.
void add_knots(DriveSearch& s, const PreparedScene& p, double t0) {
  const auto inside = [&](double v) { return std::clamp(v, s.limits.min_voltage, s.limits.max_voltage); };
  for (std::size_t k = 0; k < s.count; ++k)
    s.variables.push_back({fmt::format("level_{}_V", k + 1), s.limits.min_voltage, s.limits.max_voltage});
  s.variables.push_back({"total_time_s", 0.5 * t0, 10 * t0});
  for (std::size_t k = 0; k < s.count; ++k) s.variables.push_back({fmt::format("part_{}", k + 1), 0.05, 1});
  const auto line = [&](const auto& voltage, double total, double last_part) {
    std::vector<double> x;
    for (std::size_t k = 0; k < s.count; ++k)
      x.push_back(inside(voltage(static_cast<double>(k) / static_cast<double>(s.count - 1))));
    x.push_back(total * t0);
    x.insert(x.end(), s.count - 1, 1.0);
    x.push_back(last_part);
    s.starts.push_back(x);
  };
  if (s.drive == piezo_drive) {
    const double gap = p.scene.device.gap.contact;
    line([](double) { return 0; }, 1.5, 1);
    // Pull towards the contact, brake, let go.
    line([&](double part) { return lifting_voltage(p, (part < 0.5 ? -0.4 : 0.3) * gap); }, 2, 1);
  } else {
    line([&](double part) { return (0.7 + 0.2 * part) * s.hold; }, 8, 0.2);                  // a slow ramp
    line([&](double part) { return (0.75 + 0.2 * part) * s.hold; }, 3, 0.2);                 // a quicker one
    line([&](double part) { return part < 0.55 ? s.hold : 0.5 * s.hold; }, 1.5, 0.1);        // throw and coast
    line([&](double part) { return part < 0.75 ? 0.3 * s.hold : 0.6 * s.hold; }, 1.8, 0.1);  // leave it to others
  }
}

void add_ramp(DriveSearch& s, const PreparedScene& p, double t0) {
  const double period = first_period(p);
  const auto inside = [&](double v) { return std::clamp(v, s.limits.min_voltage, s.limits.max_voltage); };
  s.variables = {{"level_1_V", s.limits.min_voltage, s.limits.max_voltage},
                 {"level_2_V", s.limits.min_voltage, s.limits.max_voltage},
                 {"duration_s", 0.5 * t0, 10 * t0},
                 {"edge_s", 0.005 * period, 0.5 * period}};
  for (const double duration : {8.0, 3.0}) {
    s.starts.push_back({inside(0.7 * s.hold), inside(0.9 * s.hold), duration * t0, 0.05 * period});
  }
}

Waveform step_at(const DriveSearch& s, std::span<const double> x) {
  return Step{.level = s.hold, .rise_time = std::max(x[0], std::abs(s.hold - s.before) / s.limits.max_slew)};
}

Waveform pulse_at(const DriveSearch& s, std::span<const double> x) {
  const std::size_t levels = (x.size() - 1) / 2;
  return pulse_of(s, x.first(levels), x.subspan(levels, levels), x.back());
}

Waveform harmonic_at(const DriveSearch& s, std::span<const double> x) {
  const internal::SlewedDither d =
      internal::slewed_dither(s, x[0], x[1], std::numeric_limits<double>::infinity(), x[3], x[4], x[5]);
  return Harmonic{.base = s.hold,
                  .rise_time = d.rise_time,
                  .amplitude = d.amplitude,
                  .angular_frequency = x[1],
                  .phase = x[2],
                  .start = d.start,
                  .end = d.start + x[4],
                  .fade = d.fade};
}

// Straight lines through these voltages, each of a duration that may be 0, as slow as the driver asks for.
Waveform broken_line(const DriveSearch& s, std::span<const double> voltages, std::span<const double> durations) {
  Table table{.time = {0}, .voltage = {s.before}};
  for (std::size_t k = 0; k < voltages.size(); ++k) {
    const double rise = std::abs(voltages[k] - table.voltage.back()) / s.limits.max_slew;
    table.time.push_back(table.time.back() + std::max(durations[k], rise));
    table.voltage.push_back(voltages[k]);
  }
  return table;
}

Waveform knots_at(const DriveSearch& s, std::span<const double> x) {
  const std::span<const double> parts = x.subspan(s.count + 1);
  const double all = std::accumulate(parts.begin(), parts.end(), 0.0);
  std::vector<double> voltages(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(s.count)), durations{0};
  voltages.push_back(s.hold);
  for (const double part : parts) durations.push_back(x[s.count] * part / all);
  return broken_line(s, voltages, durations);
}

Waveform ramp_at(const DriveSearch& s, std::span<const double> x) {
  return broken_line(s, std::array{x[0], x[1], s.hold}, std::array{0.0, x[2], x[3]});
}

Parameters of_step(const DriveSearch&, const Waveform& waveform) {
  return std::vector<double>{std::get<Step>(waveform).rise_time};
}

Parameters of_pulse(const DriveSearch& s, const Waveform& waveform) {
  const auto& pulse = std::get<Pulse>(waveform);
  if (2 * pulse.times.size() + 1 != s.variables.size()) return std::nullopt;
  std::vector<double> x(pulse.levels.begin(), pulse.levels.end() - 1);
  double before = 0;
  for (const double time : pulse.times) {
    x.push_back(time - before);
    before = time;
  }
  x.push_back(pulse.edge);
  return x;
}

Parameters of_harmonic(const DriveSearch&, const Waveform& waveform) {
  const auto& dither = std::get<Harmonic>(waveform);
  const double duration = dither.end - dither.start;
  return std::vector<double>{dither.amplitude, dither.angular_frequency, dither.phase, dither.start,
                             duration,         dither.fade / duration};
}

// Lines that begin with a jump, as all that are searched without a limit of the slew.
bool begins_with_jump(const DriveSearch& s, const Table& table, std::size_t rows) {
  return table.time.size() == rows && table.time[1] == 0 && table.voltage[0] == s.before;
}

Parameters of_knots(const DriveSearch& s, const Waveform& waveform) {
  const auto& table = std::get<Table>(waveform);
  if (!begins_with_jump(s, table, s.count + 2)) return std::nullopt;
  std::vector<double> x(table.voltage.begin() + 1, table.voltage.end() - 1), parts;
  for (std::size_t k = 2; k < table.time.size(); ++k) parts.push_back(table.time[k] - table.time[k - 1]);
  const double longest = *std::max_element(parts.begin(), parts.end());
  x.push_back(table.time.back());
  for (const double part : parts) x.push_back(part / longest);
  return x;
}

Parameters of_ramp(const DriveSearch& s, const Waveform& waveform) {
  const auto& table = std::get<Table>(waveform);
  if (!begins_with_jump(s, table, 4)) return std::nullopt;
  return std::vector<double>{table.voltage[1], table.voltage[2], table.time[2], table.time[3] - table.time[2]};
}

constexpr auto searched_families = std::to_array<SearchedFamily>(
    {{FamilyOf<Step>::name, FamilyOf<Step>::name, 0, add_step, step_at, of_step},
     {FamilyOf<Pulse>::name, FamilyOf<Pulse>::name, 0, add_pulse, pulse_at, of_pulse},
     {FamilyOf<Harmonic>::name, FamilyOf<Harmonic>::name, 0, add_harmonic, harmonic_at, of_harmonic},
     {"catch", FamilyOf<Pulse>::name, 0, add_catch, pulse_at, of_pulse},
     {"ramp", FamilyOf<Table>::name, 0, add_ramp, ramp_at, of_ramp},
     {"staircase", FamilyOf<Pulse>::name, 4, add_staircase, pulse_at, of_pulse},
     {"knots", FamilyOf<Table>::name, 6, add_knots, knots_at, of_knots},
     {"coast", FamilyOf<Pulse>::name, 0, internal::add_coast, internal::coast_at, internal::of_coast},
     {"dual-pulse", FamilyOf<Pulse>::name, 0, internal::add_dual_pulse, internal::pulses_at, internal::of_pulses},
     {"pulses", FamilyOf<Pulse>::name, 3, internal::add_pulses, internal::pulses_at, internal::of_pulses},
     {"s-curve", FamilyOf<SCurve>::name, 0, internal::add_s_curve, internal::s_curve_at, internal::of_s_curve},
     {"dither", FamilyOf<Chirp>::name, 0, internal::add_dither, internal::dither_at, internal::of_dither},
     {"chirp", FamilyOf<Chirp>::name, 0, internal::add_chirp, internal::chirp_at, internal::of_chirp},
     {"bspline", FamilyOf<BSpline>::name, 6, internal::add_bspline, internal::bspline_at, internal::of_bspline},
     {"sines", FamilyOf<Sines>::name, 4, internal::add_sines, internal::sines_at, internal::of_sines}});

constexpr std::size_t fewest = 2, most = 20;  // of levels, knots, pulses or sines

}  // namespace

void choose_family(DriveSearch& s, const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string_view name = std::string_view(text).substr(0, colon);
  const auto* found = std::find_if(searched_families.begin(), searched_families.end(),
                                   [&](const SearchedFamily& family) { return family.name == name; });
  require_request(found != searched_families.end(),
                  [&] { return fmt::format("{} {}: must be {}", requested("waveform"), text, listed_searched_families()); });
  s.family = found;
  s.count = found->count;
  if (colon == std::string::npos) return;
  const std::string_view number = std::string_view(text).substr(colon + 1);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), s.count);
  require_request(
      found->count > 0 && error == std::errc() && end == number.data() + number.size() && s.count >= fewest && s.count <= most,
      [&] {
        return found->count == 0 ? fmt::format("{} {}: {} has no number", requested("waveform"), text, name)
                                 : fmt::format("{} {}: the number after {} must be from {} to {}", requested("waveform"), text,
                                               name, fewest, most);
      });
}

std::string listed_searched_families() {
  std::string text;
  for (std::size_t i = 0; i < searched_families.size(); ++i) {
    const SearchedFamily& family = searched_families[i];
    text += fmt::format("{}{}{}",
                        i == 0                              ? ""
                        : i + 1 == searched_families.size() ? " or "
                                                            : ", ",
                        family.name, family.count > 0 ? ":N" : "");
  }
  return text;
}

}  // namespace softland
