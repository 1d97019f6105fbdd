#include "studies/search/searched_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/engineering.h"
#include "base/require.h"
#include "model/constants.h"
#include "studies/search/bang_bang.h"
#include "studies/search/swing.h"

namespace softland::internal {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

void add_variables(DriveSearch& s, const char* what, const char* unit, std::size_t count, double lower, double upper) {
  for (std::size_t k = 1; k <= count; ++k) s.variables.push_back({fmt::format("{}_{}{}", what, k, unit), lower, upper});
}

double longest_rise(const DriveSearch& s) { return std::abs(s.hold - s.before) / s.limits.max_slew; }

}  // namespace

double inside(const DriveSearch& s, double voltage) { return std::clamp(voltage, s.limits.min_voltage, s.limits.max_voltage); }

double lifting_voltage(const PreparedScene& p, double lift) {
  const Eigen::VectorXd squares = p.model.basis().angular_frequencies().cwiseAbs2();
  const double per_volt = p.model.basis().contact_shape().dot(p.model.basis().piezo_shape().cwiseQuotient(squares));
  return -lift / per_volt;
}

double first_period(const PreparedScene& p) { return 2 * pi / p.model.basis().angular_frequencies()[0]; }

std::optional<ThrowAndCoast> throw_and_coast(const DriveSearch& s, const PreparedScene& p) {
  if (s.brakes) return std::nullopt;
  const std::vector<std::string> names = p.drive_names();
  std::vector<double> driven = hold_levels(p.signals());
  std::vector<double> coasting = driven;
  const bool is_piezo = s.drive == piezo_drive;
  const bool low_pulls = is_piezo && lifting_voltage(p, 1) > 0;
  ThrowAndCoast found{.pulling = low_pulls ? s.limits.min_voltage : s.limits.max_voltage,
                      .coasting = is_piezo ? (low_pulls ? s.limits.max_voltage : s.limits.min_voltage) : inside(s, 0)};
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == s.drive) driven[k] = found.pulling, coasting[k] = found.coasting;
  }
  // Use the quickest pull and release of the model with all modes; if the gas film is compressible, that of the first mode
  // alone.
  if (p.model.film_states() == 0 && p.rest()) {
    constexpr double longest = 3;  // longest closing by pull and release, in periods of the first mode
    const std::optional<Swing> swing = quickest_swing(p.model, driven, coasting, longest * first_period(p), p.values_before());
    if (!swing) return std::nullopt;
    found.driven_time = swing->driven_time;
    found.coasting_time = swing->releasing_time;
    return found;
  }
  const std::optional<BangBang> landing = bang_bang(p.model, driven, coasting, p.values_before());
  if (!landing) return std::nullopt;
  found.driven_time = landing->driven_time;
  found.coasting_time = landing->coasting_time;
  return found;
}

void add_s_curve(DriveSearch& s, const PreparedScene& p, double t0) {
  const double period = first_period(p);
  s.variables = {
      {"level_1_V", s.limits.min_voltage, s.limits.max_voltage}, {"dwell_1_s", 0.01 * t0, 3 * t0}, {"edge_s", 0.01 * t0, 3 * t0}};
  if (s.drive == piezo_drive) {
    for (const double lift : {-0.1, 0.3})
      s.starts.push_back({inside(s, lifting_voltage(p, lift * p.scene.device.contact_gap())), t0, 0.3 * period});
  } else if (s.brakes) {
    for (const double brake : {0.3, 0.6}) s.starts.push_back({inside(s, brake * s.limits.max_voltage), 0.5 * t0, 0.3 * t0});
  } else {
    for (const double level : {0.75, 0.95}) s.starts.push_back({inside(s, level * s.hold), 1.5 * t0, t0});
  }
}

Waveform s_curve_at(const DriveSearch& s, std::span<const double> x) {
  // The steepest slope of a half-cosine edge is pi / 2 times that of a straight edge of the same duration.
  const double rise = std::max(std::abs(x[0] - s.before), std::abs(s.hold - x[0])) * pi / 2 / s.limits.max_slew;
  const double edge = std::max(x[2], rise * (1 + 1e-12));
  return SCurve{.levels = {x[0], s.hold}, .times = {edge + x[1]}, .edge = edge};
}

Parameters of_s_curve(const DriveSearch&, const Waveform& waveform) {
  const auto& curve = std::get<SCurve>(waveform);
  if (curve.levels.size() != 2) return std::nullopt;
  return std::vector<double>{curve.levels[0], curve.times[0] - curve.edge, curve.edge};
}

double add_dither_variables(DriveSearch& s, const PreparedScene& p, double t0) {
  const double room = std::min(s.limits.max_voltage - s.hold, s.hold - s.limits.min_voltage);
  require(room > 0, fmt::format("driver.{}: the hold level {} stands at the driver's limit, which leaves no room for a dither",
                                s.drive, engineering(s.hold, "V", 5)));
  const Eigen::VectorXd& omega = p.model.basis().angular_frequencies();
  const Eigen::Index mode = std::min<Eigen::Index>(s.drive == piezo_drive ? 2 : 1, omega.size() - 1);
  const double upper = omega.size() > 1 ? omega[mode] : 6 * omega[0];
  s.variables = {{"amplitude_V", 0, room},           {"angular_frequency_rad_s", 0.2 * omega[0], upper},
                 {"phase_rad", 0, 2 * pi},           {"start_s", 0, t0},
                 {"duration_s", 0.1 * t0, 2.5 * t0}, {"fade", 0, 0.5}};
  return upper;
}

SlewedDither slewed_dither(const DriveSearch& s, double amplitude, double omega, double decay, double start, double duration,
                           double fade) {
  // With a slew limit the sine begins after the rise to its base voltage, and its fades are longer, since the slope of the
  // envelope adds to that of the sine. A fade is at most half the duration; if the sine is still too steep, its amplitude is
  // reduced.
  const double slew = s.limits.max_slew, rise = longest_rise(s);  // infinite and 0 [s] without a slew limit
  const double turning = omega + 1 / decay;
  const double needed = amplitude * turning < slew ? amplitude / (slew - amplitude * turning) : never;
  const double longer = std::min(std::max(fade * duration, needed), duration / 2);
  const double steepest = turning + (longer > 0 ? 1 / longer : 0);
  return {.rise_time = rise, .start = std::max(start, rise), .fade = longer, .amplitude = std::min(amplitude, slew / steepest)};
}

void add_dither(DriveSearch& s, const PreparedScene& p, double t0) {
  const double upper = add_dither_variables(s, p, t0), room = s.variables[0].upper;
  s.variables.push_back({"decay_time_s", 0.05 * t0, 5 * t0});
  for (const double frequency : {0.15, 0.45}) s.starts.push_back({room / 2, frequency * upper, pi, 0, 1.5 * t0, 0.2, t0});
}

Waveform dither_at(const DriveSearch& s, std::span<const double> x) {
  const SlewedDither d = slewed_dither(s, x[0], x[1], x[6], x[3], x[4], x[5]);
  return Chirp{.base = s.hold,
               .rise_time = d.rise_time,
               .amplitude = d.amplitude,
               .angular_frequency = x[1],
               .phase = x[2],
               .start = d.start,
               .end = d.start + x[4],
               .fade = d.fade,
               .decay_time = x[6]};
}

Parameters of_dither(const DriveSearch&, const Waveform& waveform) {
  const auto& c = std::get<Chirp>(waveform);
  if (c.frequency_ratio != 1 || !std::isfinite(c.decay_time)) return std::nullopt;
  const double duration = c.end - c.start;
  return std::vector<double>{c.amplitude, c.angular_frequency, c.phase, c.start, duration, c.fade / duration, c.decay_time};
}

void add_chirp(DriveSearch& s, const PreparedScene& p, double t0) {
  const double upper = add_dither_variables(s, p, t0), room = s.variables[0].upper;
  s.variables.push_back({"frequency_ratio", 0.25, 4});
  for (const double ratio : {0.5, 2.0}) s.starts.push_back({room / 2, 0.3 * upper, pi, 0, 1.5 * t0, 0.2, ratio});
}

Waveform chirp_at(const DriveSearch& s, std::span<const double> x) {
  const SlewedDither d = slewed_dither(s, x[0], x[1] * std::max(1.0, x[6]), never, x[3], x[4], x[5]);
  return Chirp{.base = s.hold,
               .rise_time = d.rise_time,
               .amplitude = d.amplitude,
               .angular_frequency = x[1],
               .frequency_ratio = x[6],
               .phase = x[2],
               .start = d.start,
               .end = d.start + x[4],
               .fade = d.fade};
}

Parameters of_chirp(const DriveSearch&, const Waveform& waveform) {
  const auto& c = std::get<Chirp>(waveform);
  if (std::isfinite(c.decay_time)) return std::nullopt;
  const double duration = c.end - c.start;
  return std::vector<double>{c.amplitude, c.angular_frequency, c.phase, c.start, duration, c.fade / duration, c.frequency_ratio};
}

void add_bspline(DriveSearch& s, const PreparedScene& p, double t0) {
  add_variables(s, "level", "_V", s.count, s.limits.min_voltage, s.limits.max_voltage);
  s.variables.push_back({"duration_s", 0.5 * t0, 10 * t0});
  const auto curve = [&](const auto& voltage, double duration) {
    std::vector<double> x;
    for (std::size_t k = 0; k < s.count; ++k)
      x.push_back(inside(s, voltage((static_cast<double>(k) + 0.5) / static_cast<double>(s.count))));
    x.push_back(duration * t0);
    s.starts.push_back(x);
  };
  const double hold = s.hold, low = s.limits.min_voltage, high = s.limits.max_voltage;
  if (s.drive == piezo_drive) {
    const double gap = p.scene.device.contact_gap();
    curve([](double) { return 0; }, 1.5);
    curve([&](double part) { return lifting_voltage(p, (part < 0.5 ? -0.4 : 0.3) * gap); }, 2);
  } else if (s.brakes) {
    curve([](double) { return 0; }, 1.5);
    curve([&](double part) { return part > 0.4 && part < 0.8 ? 0.6 * high : 0; }, 1.5);
  } else {
    curve([&](double part) { return (0.7 + 0.2 * part) * hold; }, 8);
    curve([&](double part) { return part < 0.5 ? hold : 0.5 * hold; }, 1.5);
    if (const auto landing = throw_and_coast(s, p)) {
      const double both = landing->driven_time + landing->coasting_time, share = landing->driven_time / both;
      curve([&](double part) { return part < share ? high : low; }, both / t0);
    }
  }
}

Waveform bspline_at(const DriveSearch& s, std::span<const double> x) {
  // The spline begins at the first level, or with a slew limit at the voltage before t = 0. It ends with two hold levels, for a
  // smooth end.
  BSpline spline{.levels = {}, .duration = x.back()};
  if (std::isfinite(s.limits.max_slew)) spline.levels.push_back(s.before);
  spline.levels.insert(spline.levels.end(), x.begin(), x.end() - 1);
  spline.levels.insert(spline.levels.end(), 2, s.hold);
  // The derivative of the spline is a B-spline, too, and is therefore bounded by its largest coefficient. Lengthen the duration
  // until this bound keeps the slew limit.
  const std::size_t n = spline.levels.size();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double part = (bspline_knot(i + 4, n) - bspline_knot(i + 1, n)) / static_cast<double>(n - 3);
    spline.duration = std::max(spline.duration,
                               3 * std::abs(spline.levels[i + 1] - spline.levels[i]) / (part * s.limits.max_slew) * (1 + 1e-9));
  }
  return spline;
}

Parameters of_bspline(const DriveSearch& s, const Waveform& waveform) {
  const auto& spline = std::get<BSpline>(waveform);
  if (spline.levels.size() != s.count + 2 || spline.levels[s.count] != s.hold) return std::nullopt;
  std::vector<double> x(spline.levels.begin(), spline.levels.end() - 2);
  x.push_back(spline.duration);
  return x;
}

void add_sines(DriveSearch& s, const PreparedScene& p, double t0) {
  const double range = s.limits.max_voltage - s.limits.min_voltage;
  add_variables(s, "amplitude", "_V", s.count, -range, range);
  s.variables.push_back({"duration_s", 0.5 * t0, 4 * t0});
  const auto start = [&](double first, double second, double duration) {
    std::vector<double> x(s.count, 0.0);
    x[0] = first, x[1] = second;
    x.push_back(duration * t0);
    s.starts.push_back(x);
  };
  if (s.drive == piezo_drive) {
    const double volts = std::abs(lifting_voltage(p, 0.3 * p.scene.device.contact_gap())),
                 sign = lifting_voltage(p, 1) > 0 ? 1 : -1;
    start(0, -sign * std::min(volts, 0.4 * range), 2);
    start(sign * std::min(volts, 0.4 * range), 0, 2);
  } else if (s.brakes) {
    start(0.2 * range, 0, 1.5);
    start(0.1 * range, -0.1 * range, 1.5);
  } else {
    start(-0.3 * s.hold, 0.1 * s.hold, 1.8);
    start(-0.5 * s.hold, 0.3 * s.hold, 1.5);
  }
}

Waveform sines_at(const DriveSearch& s, std::span<const double> x) {
  Sines sines{.base = s.hold,
              .rise_time = longest_rise(s),
              .amplitudes = {x.begin(), x.end() - 1},
              .start = longest_rise(s),
              .duration = x.back()};
  // Beyond the voltage or slew limits all amplitudes are reduced by one factor, so that the ratios of the sines remain.
  Sines alone = sines;
  alone.base = 0;
  const Signal swing = signal(alone);
  const auto [minimum, up] = swing.range();
  const double down = -minimum, steepest = std::isfinite(s.limits.max_slew) ? swing.peak_slew() : 0;
  double share = 1;
  if (up > s.limits.max_voltage - s.hold) share = std::min(share, (s.limits.max_voltage - s.hold) / up);
  if (down > s.hold - s.limits.min_voltage) share = std::min(share, (s.hold - s.limits.min_voltage) / down);
  if (steepest > s.limits.max_slew) share = std::min(share, s.limits.max_slew / steepest);
  constexpr double precision = 1e-7;  // relative error of the computed extrema of the sum of sines
  if (share < 1) {
    for (double& amplitude : sines.amplitudes) amplitude *= share * (1 - precision);
  }
  return sines;
}

Parameters of_sines(const DriveSearch& s, const Waveform& waveform) {
  const auto& sines = std::get<Sines>(waveform);
  if (sines.amplitudes.size() != s.count) return std::nullopt;
  std::vector<double> x = sines.amplitudes;
  x.push_back(sines.duration);
  return x;
}

}  // namespace softland::internal
