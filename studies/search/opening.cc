#include "studies/search/opening.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "base/engineering.h"
#include "base/executor.h"
#include "base/require.h"
#include "config/assumed_spread.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "sampling/statistics.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/simulate.h"
#include "studies/devices/ensemble.h"
#include "studies/search/search_budget.h"
#include "studies/search/search_setting.h"
#include "studies/search/verification.h"

namespace softland {
namespace {

constexpr int brake_pulses = 2;  // number of voltage pulses of every drive that brakes the opening

// Weight, in the cost of an opening, of its settling time in periods of the first mode. The residual vibration in contact gaps
// has the weight 1.
constexpr double time_share = 0.3;
// Additional weight, in the cost of an opening, of the vibration's excess over the band about the open position.
constexpr double outside_share = 5;
constexpr double stays_closed = 10;         // cost of an opening waveform under which the switch stays closed
constexpr double touched_again = 0.5;       // additional cost of every contact after the first opening
constexpr double opening_tolerance = 1e-5;  // relative tolerance of the integrator in simulated openings
// Number of periods of the first mode, after all drives are at 0 V, over which a candidate's vibration is measured.
constexpr double seen_for = 1;
constexpr double watched_for = 3;  // least number of periods over which the best waveform's vibration is measured

// Time in which a voltage source settles at its hold level before the command to open, in time constants of the source.
constexpr double settled_after = 50;

class ReleaseSearch {
 public:
  ReleaseSearch(const PreparedScene& given, const OpeningOptions& options)
      : given_(given),
        options_(options),
        gap_(given.scene.device.contact_gap()),
        period_(2 * pi / given.model.basis().angular_frequencies()[0]),
        pulses_(given, options.actuator, hold_levels(signals_of(given.waveforms())), "release"),
        plain_(applied(pulses_.plain())) {}

  /// Returns the signals of the plain opening: every drive goes to 0 V at once, or as fast as its source can.
  [[nodiscard]] const std::vector<Signal>& plain() const { return plain_; }
  [[nodiscard]] std::vector<Signal> signals(std::span<const double> x) const { return applied(pulses_.commanded(x)); }

  /// Returns the scene with the commanded voltages of all drives at the point `x` of the search, which begin at the hold
  /// levels. An empty `x` gives the plain opening.
  [[nodiscard]] SceneFile scene(std::span<const double> x) const {
    const std::vector<Corners> commanded = x.empty() ? pulses_.plain() : pulses_.commanded(x);
    const std::vector<std::string> names = given_.drive_names();
    DriveWaveforms waveforms;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (names[k] == dispersion_drive) continue;  // the dispersion force counts as a drive, but has no voltage
      Table table;
      for (const auto& [time, voltage] : commanded[k]) {
        table.time.push_back(time);
        table.voltage.push_back(voltage);
      }
      waveforms[names[k]] = std::move(table);
    }
    SceneFile file = with_waveforms(given_, waveforms);
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (!waveforms.contains(names[k])) continue;
      file.set(fmt::format("waveform.{}.before=\"{} V\"", names[k], pulses_.holds()[k]));
      file.set(fmt::format("waveform.{}.before_state=closed", names[k]));
    }
    return file;
  }

  /// Simulates an opening of the switch `model`, which may have more modes than the scene's.
  [[nodiscard]] Opening open(const Switch& model, std::span<const double> closed, std::vector<Signal> signals, double tolerance,
                             double window, const std::atomic<bool>* stop = nullptr) const {
    Opening o{.signals = std::move(signals), .voltages_end = 0, .trajectory = {}, .figures = {}};
    for (const Signal& one : o.signals) o.voltages_end = std::max(o.voltages_end, one.breakpoints().back());
    window =
        std::isfinite(window) ? std::max(window, o.voltages_end + watched_for * period_) : o.voltages_end + seen_for * period_;
    o.trajectory =
        simulate_closing(model, o.signals, {.duration = window, .tolerance = tolerance, .begins_closed = closed, .stop = stop});
    o.figures = release_figures(o.trajectory, {.open_position = model.contact_deflection(model.rest()->data()),
                                               .width = options_.band * gap_,
                                               .drives_end = o.voltages_end});
    return o;
  }

  [[nodiscard]] double cost(const Opening& o) const {
    const OpeningFigures& f = o.figures;
    if (o.trajectory.status != Status::done) return OpeningFigures::unset;
    if (!std::isfinite(f.release_time)) return stays_closed;
    const double time = std::isfinite(f.settling_time) ? f.settling_time : std::max(o.voltages_end, f.release_time);
    const double outside = std::max(0.0, f.residual_vibration / gap_ - options_.band);
    return f.residual_vibration / gap_ + outside_share * outside + time_share * time / period_ + touched_again * f.touches;
  }

  [[nodiscard]] OptimizerResult run(std::span<const double> closed, const Progress& progress) const {
    SearchBudget budget({.evaluations = options_.max_evaluations, .stop = progress.stop});
    const auto objective = [&](std::span<const double> x) {
      return cost(open(given_.model, closed, signals(x), opening_tolerance, OpeningFigures::unset, progress.stop));
    };
    return minimize_within(budget, {.variables = pulses_.variables(), .objective = objective, .starts = pulses_.starts()},
                           options_.seed, options_.jobs, progress, "waveforms");
  }

  [[nodiscard]] std::map<std::string, double> named(const std::vector<double>& x) const {
    std::map<std::string, double> all;
    for (std::size_t k = 0; k < x.size(); ++k) all[pulses_.variables()[k].name] = x[k];
    return all;
  }

 private:
  [[nodiscard]] std::vector<Signal> applied(const std::vector<Corners>& commanded) const {
    std::vector<Signal> all;
    for (std::size_t k = 0; k < commanded.size(); ++k) all.push_back(applied(k, commanded[k]));
    return all;
  }

  // Returns the voltage that the source of drive k applies when the commanded voltage follows `points`. Before t = 0 the source
  // has settled at the first commanded voltage.
  [[nodiscard]] Signal applied(std::size_t k, Corners points) const {
    const DriverModel& source = given_.drives[k].source;
    const SourceErrors& errors = given_.drives[k].errors;
    if (source.is_ideal() && errors.are_none()) return Signal::piecewise_linear(points);
    double stands = period_ + errors.delay;
    if (source.bandwidth) stands += settled_after / (2 * pi * *source.bandwidth);
    stands += settled_after * source.charging_time();
    if (source.sample_rate) stands = std::ceil(stands * *source.sample_rate) / *source.sample_rate;
    for (auto& [time, voltage] : points) time += stands;
    points.insert(points.begin(), {0, points.front().second});
    return part_from(given_.applied(k, Signal::piecewise_linear(points)), stands);
  }

  const PreparedScene& given_;
  const OpeningOptions& options_;
  double gap_, period_;
  BrakePulses pulses_;
  std::vector<Signal> plain_;
};

bool is_open_with_drives(const OpeningFigures& f, double band) {
  return f.status == Status::done && f.residual_vibration <= band;
}

double quantile_95(const std::vector<OpeningFigures>& openings, double OpeningFigures::*figure) {
  std::vector<double> values;
  for (const OpeningFigures& of_device : openings) {
    const double value = of_device.*figure;
    values.push_back(std::isnan(value) ? std::numeric_limits<double>::infinity() : value);
  }
  return sample_quantile(values, 0.95);
}

DeviceOpenings summarised(const std::vector<OpeningFigures>& openings, double band) {
  const auto share = [&](const auto& holds) {
    return static_cast<double>(std::ranges::count_if(openings, holds)) / static_cast<double>(openings.size());
  };
  return {.open = share([](const OpeningFigures& f) { return f.status == Status::done; }),
          .in_band = share([&](const OpeningFigures& f) { return is_open_with_drives(f, band); }),
          .settling_time = quantile_95(openings, &OpeningFigures::settling_time),
          .residual_vibration = quantile_95(openings, &OpeningFigures::residual_vibration),
          .overshoot = quantile_95(openings, &OpeningFigures::overshoot)};
}

// Returns the figures of the openings of varied devices; none if no device is closed under its hold levels.
std::optional<OpeningsOnDevices> on_devices(const ReleaseSearch& search, const OpeningResult& r, const Progress& progress) {
  SceneFile file = r.given.scene.file;
  OpeningsOnDevices found{.spread_assumed = assume_spread(file), .plain = {}, .best = {}};
  const PreparedScene nominal = found.spread_assumed ? prepare(file) : r.given;
  found.spread = nominal.scene.spread;
  const Ensemble ensemble(nominal, r.options.devices, r.options.seed);
  std::vector<std::optional<std::pair<OpeningFigures, OpeningFigures>>> of_device(ensemble.size());
  std::atomic<std::size_t> done = 0;
  run_tasks(
      ensemble.size(), r.options.jobs,
      [&](std::size_t k) {
        const SampledDevice device = DeviceBuilder(ensemble).device(k);
        progress.tell("devices", static_cast<double>(++done) / static_cast<double>(ensemble.size()));
        if (!device.model || !device.model->rest()) return;
        const std::optional<ClosedEquilibrium> closed = closed_equilibrium(*device.model, r.holds);
        if (!keeps_closed(*device.model, closed)) return;
        const std::span<const double> at = closed->coordinates();
        const auto opened = [&](const std::vector<Signal>& signals) {
          return search.open(*device.model, at, signals, opening_tolerance, r.window, progress.stop).figures;
        };
        of_device[k].emplace(opened(r.plain.signals), opened(r.best->signals));
      },
      progress.stop);
  if (progress.stopped()) return std::nullopt;
  std::vector<OpeningFigures> plain, best;
  for (const auto& one : of_device) {
    if (!one) continue;
    plain.push_back(one->first);
    best.push_back(one->second);
  }
  if (best.empty()) return std::nullopt;
  found.devices = best.size();
  found.plain = summarised(plain, r.band);
  found.best = summarised(best, r.band);
  return found;
}

}  // namespace

BrakePulses::BrakePulses(const PreparedScene& given, Actuator actuator, std::vector<double> holds, std::string_view asker)
    : given_(given), period_(2 * pi / given.model.basis().angular_frequencies()[0]), holds_(std::move(holds)) {
  const Device& device = given.scene.device;
  const std::vector<std::string> names = given.drive_names();
  const bool electrodes = actuator != Actuator::pzt, piezo = actuator != Actuator::electrostatic;
  const std::string asked = std::string(asker) + " " + requested("actuator");
  require_request(!electrodes || !device.electrodes.empty(),
                  [&] { return asked + " electrostatic|both needs an electrode, and the scene has none"; });
  require_request(!piezo || device.piezo, [&] { return asked + " pzt|both needs a [piezo] section, and the scene has none"; });
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::optional<DriverLimits>& limits = given.drives[k].limits;
    plain_.push_back({{0, holds_[k]}, {limits ? std::abs(holds_[k]) / limits->max_slew : 0, 0}});
    const bool is_electrode = k < device.electrodes.size();
    if (!(is_electrode ? electrodes : piezo && names[k] == piezo_drive)) continue;
    if (is_electrode && !limits) continue;
    require_request(limits.has_value(), [&] {
      return asked + " pzt|both needs limits for the piezo: write min_voltage and max_voltage under [driver.piezo]";
    });
    add_brake(k, names[k], *limits);
  }
  require(!brakes_.empty(), [&] {
    return std::string(asker) + " needs a drive with limits: write max_voltage under [driver.NAME] of an electrode";
  });
}

void BrakePulses::add_brake(std::size_t drive, const std::string& name, const DriverLimits& limits) {
  brakes_.push_back({.drive = drive, .first = variables_.size(), .limits = limits});
  const double span = std::max(std::abs(limits.min_voltage), std::abs(limits.max_voltage));
  const double shortest = std::max(0.005 * period_, std::max(std::abs(holds_[drive]), span) / limits.max_slew);
  variables_.push_back({name + ".edge", shortest, std::max(0.1 * period_, 2 * shortest)});
  for (int k = 1; k <= brake_pulses; ++k) {
    variables_.push_back({fmt::format("{}.wait_{}", name, k), 0, period_});
    variables_.push_back({fmt::format("{}.level_{}", name, k), limits.min_voltage, limits.max_voltage});
    variables_.push_back({fmt::format("{}.duration_{}", name, k), 0.01 * period_, period_});
  }
}

std::vector<std::vector<double>> BrakePulses::starts() const {
  std::vector<std::vector<double>> all;
  for (const Brake& b : brakes_) {
    const double most = b.limits.max_voltage, least = b.limits.min_voltage;
    for (const double duration : {0.1, 0.25}) {
      for (const double level : {most, most / 2, least}) {
        if (level == 0) continue;
        for (const double wait : {0.1, 0.2, 0.3}) all.push_back(start(b, {wait, level, duration, 0.1, 0, 0.1}));
      }
      if (!(least < 0)) continue;
      for (const double first : {0.1, 0.25}) {
        all.push_back(start(b, {0, most, first, 0, least, duration}));
        all.push_back(start(b, {0, least, first, 0, most, duration}));
      }
    }
  }
  return all;
}

// Returns the point of the search at which only the drive `braking` gives its two pulses. The other drives stay at 0 V.
// `pulse_train` has wait, level [V] and duration of each pulse, with times in periods of the first mode.
std::vector<double> BrakePulses::start(const Brake& braking, const std::array<double, 6>& pulse_train) const {
  std::vector<double> x;
  for (const Brake& b : brakes_) {
    const bool brakes = b.drive == braking.drive;
    const auto& [wait, level, duration, next_wait, next_level, next_duration] = pulse_train;
    x.insert(x.end(), {variables_[b.first].lower, wait * period_, brakes ? level : 0, duration * period_, next_wait * period_,
                       brakes ? next_level : 0, next_duration * period_});
  }
  return x;
}

std::vector<Corners> BrakePulses::commanded(std::span<const double> x) const {
  std::vector<Corners> all = plain_;
  for (const Brake& brake : brakes_) all[brake.drive] = corners(brake, x);
  return all;
}

Corners BrakePulses::corners(const Brake& brake, std::span<const double> x) const {
  const double edge = x[brake.first];
  double t = edge;
  Corners all{{0, holds_[brake.drive]}, {t, 0}};
  for (std::size_t k = 0; k < brake_pulses; ++k) {
    const auto own = x.subspan(brake.first + 1 + 3 * k, 3);
    const double level = own[1];
    for (const auto& [lasts, value] : {std::pair{own[0], 0.0}, {edge, level}, {own[2], level}, {edge, 0.0}}) {
      t += lasts;
      all.emplace_back(t, value);
    }
  }
  return all;
}

bool gains(const OpeningFigures& a, const OpeningFigures& b) {
  if (!std::isfinite(a.release_time)) return false;
  if (!std::isfinite(b.release_time)) return true;
  const bool a_settles = std::isfinite(a.settling_time), b_settles = std::isfinite(b.settling_time);
  if (a_settles != b_settles) return a_settles;
  constexpr double most = 1 - least_gain;
  return a_settles ? a.settling_time <= most * b.settling_time : a.residual_vibration <= most * b.residual_vibration;
}

OpeningResult search_opening(const SceneFile& file, const OpeningOptions& options, const Progress& progress) {
  require(options.band > 0 && options.band < 1, fmt::format("band = {}: must be above 0 and below 1 contact gap", options.band));
  OpeningResult r{.given = prepare_and_choose(file, true, progress), .options = options};
  const PreparedScene& given = r.given;
  require(given.model.has_contact(), "release needs a [contact] section to open from, and the scene has none");
  require(given.model.rest().has_value(), "with every drive at 0 V the switch has no stable open state: it cannot be opened");
  const ReleaseSearch search(given, options);
  const double gap = given.scene.device.contact_gap();
  r.holds = hold_levels(given.signals());
  r.open_position = given.model.contact_deflection(given.model.rest()->data());
  r.band = options.band * gap;
  r.window = given.duration;
  const std::optional<ClosedEquilibrium> closed = closed_equilibrium(given.model, r.holds);
  require(keeps_closed(given.model, closed), [&] {
    const std::string unstable = warning(closed_state(given, given.signals()));
    return unstable.empty() ? std::string(not_held) : unstable;
  });
  r.contact_force = closed->contact_force;
  const auto open = [&](std::vector<Signal> signals) {
    return search.open(given.model, closed->coordinates(), std::move(signals), given.tolerance, r.window, progress.stop);
  };
  r.plain = open(search.plain());
  progress.throw_if_stopped();
  r.search = search.run(closed->coordinates(), progress);
  r.interrupted = progress.stopped();
  r.scene = search.scene(r.search.x);
  if (r.search.x.empty()) return r;

  r.best = search.open(given.model, closed->coordinates(), search.signals(r.search.x), given.tolerance, r.window);
  r.parameters = search.named(r.search.x);
  const auto check = [&](const std::string& name, const Switch& model, double tolerance) {
    const std::optional<ClosedEquilibrium> its = closed_equilibrium(model, r.holds);
    OpeningFigures figures{.status = Status::numerical_failure};
    if (its && model.rest()) figures = search.open(model, its->coordinates(), r.best->signals, tolerance, r.window).figures;
    r.checks.push_back({name, figures});
  };
  check("tolerance " + engineering(tight_tolerance, ""), given.model, tight_tolerance);
  for (const Device& richer : with_more_modes(given.scene.device))
    check(fmt::format("modes {}", richer.structure.modes), Switch(richer, quadrature_of_richer(given.quadrature, richer)),
          given.tolerance);
  r.better = gains(r.best->figures, r.plain.figures);
  const auto meets_goal = [&](const auto& run) { return is_open_with_drives(run.figures, r.band); };
  r.goal_met = meets_goal(*r.best);
  r.confirmed = r.goal_met && std::all_of(r.checks.begin(), r.checks.end(), meets_goal);
  if (r.options.devices > 0 && !r.interrupted) r.on_devices = on_devices(search, r, progress);
  r.interrupted = progress.stopped();
  return r;
}

}  // namespace softland
