#include "studies/devices/robustness.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include "base/choice.h"
#include "base/executor.h"
#include "base/require.h"
#include "integrators/quintic.h"
#include "sampling/confidence.h"
#include "sampling/statistics.h"
#include "studies/closing/actuator.h"
#include "studies/closing/plain_step.h"

namespace softland {
namespace {

constexpr std::size_t most_worst = 10;
constexpr std::array worth_of_classes{4, 8, 16};

FigureStatistics statistics(const Figure& figure, const std::vector<DeviceOutcome>& outcomes) {
  std::vector<double> all, finite;
  for (const DeviceOutcome& o : outcomes) {
    all.push_back(o.of(figure));
    if (std::isfinite(all.back())) finite.push_back(all.back());
  }
  FigureStatistics s{.devices = finite.size()};
  if (!finite.empty()) {
    s.mean = sample_mean(finite);
    s.standard_deviation = sample_standard_deviation(finite);
    s.skewness = sample_skewness(finite);
  }
  for (std::size_t i = 0; i < robustness_quantiles.size(); ++i) s.quantiles[i] = estimated_quantile(all, robustness_quantiles[i]);
  return s;
}

void summarise(DriveRobustness& drive) {
  const std::vector<DeviceOutcome>& all = drive.outcomes;
  if (all.empty()) return;
  for (const Figure& f : device_figures) {
    if (std::ranges::any_of(all, [&](const DeviceOutcome& o) { return f.is_asked(o.metrics.asked); }))
      drive.figures[f] = statistics(f, all);
  }
  const auto count = [&](auto&& holds) { return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), holds)); };
  drive.closing = yield_of(count([](const DeviceOutcome& o) { return o.closed(); }), all.size());
  drive.collapsed =
      yield_of(count([](const DeviceOutcome& o) { return o.metrics.status == Status::collapsed_onto_electrode; }), all.size());
  drive.bounce_free = yield_of(count([](const DeviceOutcome& o) { return is_bounce_free(o); }), all.size());
  drive.worst.resize(all.size());
  std::iota(drive.worst.begin(), drive.worst.end(), std::size_t{0});
  const auto height = [&](std::size_t k) { return all[k].of(figure_of(&Metrics::major_bounce_height)); };
  const auto kept = static_cast<std::ptrdiff_t>(std::min(most_worst, all.size()));
  std::partial_sort(drive.worst.begin(), drive.worst.begin() + kept, drive.worst.end(),
                    [&](std::size_t a, std::size_t b) { return height(a) != height(b) ? height(a) > height(b) : a < b; });
  drive.worst.resize(static_cast<std::size_t>(kept));
}

// Returns the gap of the contact at `instants` instants from 0 to `end`. After the end of the closing the last value is
// repeated.
std::vector<double> sampled_gap(const Trajectory& closing, std::size_t instants, double end) {
  const std::vector<TrajectoryPoint>& knots = closing.points;
  if (knots.empty()) return {};
  std::vector<double> gap;
  std::size_t next = 0;  // index of the knot (point between integrator steps) before the instant
  for (std::size_t i = 0; i < instants; ++i) {
    const double t = end * static_cast<double>(i) / static_cast<double>(instants - 1);
    while (next < knots.size() && knots[next].time <= t) ++next;
    const TrajectoryPoint& to = knots[std::min(next, knots.size() - 1)];
    const TrajectoryPoint& from = next > 0 ? knots[next - 1] : to;
    const double position = from.time < to.time ? Quintic(from.time, from.position, from.velocity, from.acceleration, to.time,
                                                          to.position, to.velocity, to.acceleration)
                                                      .position(t)
                                                : to.position;
    gap.push_back(closing.contact_gap - position);
  }
  return gap;
}

// Returns the waveforms in the order of Switch::drives(). Drives without a waveform stay at 0 V.
std::vector<Waveform> waveforms_of(const PreparedScene& nominal, const NamedDrive& drive) {
  for (const auto& [name, waveform] : drive.waveforms) {
    const Drive* const given = nominal.drives.find(name);
    require(given != nullptr,
            [&] { return fmt::format("{}: its drive '{}' must be a drive of the first scene", drive.name, name); });
    if (!given->limits) continue;
    const DriverLimits own = limits_for(waveform, *given->limits);
    const bool may_be_samples = std::holds_alternative<Table>(waveform);
    const std::string broken = violation(nominal.commanded(nominal.drives.place(name), waveform),
                                         may_be_samples ? limits_of_samples(own, given->source) : own);
    require(broken.empty(), [&] { return fmt::format("{}: drive '{}': {}", drive.name, name, broken); });
  }
  return nominal.in_drive_order(drive.waveforms);
}

// Widens the limits of a voltage source for the signal of a device whose scale factors or errors are larger than nominal, so
// that the limits permit the signal.
void allow(SceneFile& file, const std::string& driver, const Signal& signal, const DriverLimits& limits) {
  if (violation(signal, limits).empty()) return;
  if (signal.maximum() > limits.max_voltage) file.assign(driver + ".max_voltage", signal.maximum());
  if (signal.minimum() < limits.min_voltage) file.assign(driver + ".min_voltage", signal.minimum());
  if (!(signal.peak_slew() > limits.max_slew)) return;
  if (std::isfinite(signal.peak_slew())) {
    file.assign(driver + ".max_slew", signal.peak_slew());
  } else {
    file.erase(driver + ".max_slew");  // the signal has a jump (offset of the source), which no finite limit permits
  }
}

void set_errors(SceneFile& file, const std::string& driver, const SourceErrors& errors) {
  const auto set = [&](const char* key, double value, double none) {
    const std::string path = driver + key;
    value == none ? file.erase(path) : file.assign(path, value);
  };
  set(".gain", errors.gain, 1);
  set(".offset", errors.offset, 0);
  set(".delay", errors.delay, 0);
}

struct Measurement {
  std::string_view name;
  std::optional<double> Calibration::*error;
};
constexpr std::array all_measurements{
    Measurement{measured_pull_in, &Calibration::pull_in_error}, Measurement{"closing time", &Calibration::time_error},
    Measurement{measured_frequency, &Calibration::frequency_error}, Measurement{measured_piezo, &Calibration::piezo_error}};

// Returns a set of drive waveforms with each calibration to compare: no measurements, each measurement alone, and all
// measurements, without error. With all measurements devices are first sorted into classes, then have their own scale factors.
std::vector<NamedDrive> by_knowledge(const NamedDrive& drive) {
  std::vector<NamedDrive> all;
  const auto add = [&](const std::string& name, const Calibration& calibration) {
    all.push_back({.name = name, .waveforms = drive.waveforms, .calibration = calibration});
  };
  add("nothing", {});
  std::vector<Measurement> measured;
  for (const Measurement& one : all_measurements) {
    if (drive.calibration.*one.error) measured.push_back(one);
  }
  const auto exactly = [](std::span<const Measurement> those) {
    Calibration exact;
    for (const Measurement& one : those) exact.*one.error = 0;
    return exact;
  };
  const auto named = [](std::span<const Measurement> those) {
    std::vector<std::string_view> names;
    for (const Measurement& one : those) names.push_back(one.name);
    return in_words(names);
  };
  for (std::size_t i = 0; i < measured.size() && measured.size() > 1; ++i)
    add(std::string(measured[i].name), exactly(std::span(measured).subspan(i, 1)));
  if (measured.size() > 2 && drive.calibration.piezo_error) {  // also compare all measurements except that of the piezo
    const auto others = std::span(measured).first(measured.size() - 1);
    add(named(others), exactly(others));
  }
  const Calibration exact = exactly(measured);
  const std::string name = named(measured);
  std::set<int> counts(worth_of_classes.begin(), worth_of_classes.end());
  if (drive.calibration.classes) counts.insert(*drive.calibration.classes);
  for (const int count : counts) {
    Calibration sorted = exact;
    sorted.classes = count;
    add(fmt::format("{}, {} classes", name, count), sorted);
  }
  add(name, exact);
  return all;
}

}  // namespace

EstimatedQuantile estimated_quantile(const std::vector<double>& sample, double probability) {
  return {.value = sample_quantile(sample, probability), .interval = quantile_interval(sample, probability)};
}

bool is_bounce_free(const DeviceOutcome& o) { return o.closed() && o.metrics.is_bounce_free(); }

Yield yield_of(std::size_t devices, std::size_t all) {
  return {.devices = devices,
          .value = static_cast<double>(devices) / static_cast<double>(all),
          .interval = wilson_interval(devices, all)};
}

Robustness robustness(const PreparedScene& nominal, const std::vector<NamedDrive>& drives, const RobustnessOptions& options,
                      const Progress& progress) {
  require(nominal.model.has_contact(), "robustness needs a [contact] section: without contact there is no landing");
  require_open_start(nominal.scene, "robustness closes every device");
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  const EnsembleRun run = internal::run_of(nominal, options);
  Robustness result{.duration = run.duration, .tolerance = run.tolerance};
  const Actuator driven = has_pulling_electrode(nominal.scene.device) ? Actuator::both : Actuator::pzt;
  NamedDrive plain{.name = "plain step", .waveforms = plain_step(nominal, driven)};
  plain.waveforms.merge(nominal.drives.waveforms());  // add the waveforms of drives that the plain step does not name
  std::vector<NamedDrive> all;
  // True if a set of waveforms in `all` has the same signals as `drive`, and neither has a calibration.
  const auto is_judged = [&](const NamedDrive& drive) {
    const std::vector<Signal> own = nominal.commanded(waveforms_of(nominal, drive));
    return drive.calibration.is_empty() && std::any_of(all.begin(), all.end(), [&](const NamedDrive& other) {
             return other.calibration.is_empty() && same_drives(own, nominal.commanded(waveforms_of(nominal, other)));
           });
  };
  all.push_back(plain);
  for (const NamedDrive& drive : drives) {
    if (!is_judged(drive)) all.push_back(drive);
  }
  const std::size_t shown = all.size();
  if (options.worth_of_measuring && !all.back().calibration.is_empty()) {
    for (NamedDrive& known : by_knowledge(NamedDrive(all.back()))) all.push_back(std::move(known));
  }

  std::vector<Calibration> calibrations;
  for (const NamedDrive& drive : all) calibrations.push_back(drive.calibration);
  const std::vector<MeasuredUnits> known = measured_units(nominal, calibrations, options.jobs, progress);
  std::vector<EnsembleDrive> judged;
  for (std::size_t i = 0; i < all.size(); ++i) judged.push_back({.waveforms = waveforms_of(nominal, all[i]), .known = known[i]});
  std::vector<std::vector<DeviceOutcome>> outcomes = close_all(ensemble, judged, run, progress);
  result.devices = outcomes.front().size();
  result.interrupted = progress.stopped();
  if (result.devices == 0) progress.throw_if_stopped();
  for (std::size_t i = 0; i < all.size(); ++i) {
    (i < shown ? result.drives : result.by_knowledge)
        .push_back(internal::summarised(std::move(all[i]), known[i], std::move(outcomes[i])));
  }
  return result;
}

Sensitivity sensitivity(const PreparedScene& nominal, const DriveRobustness& drive, std::uint64_t rows,
                        const RobustnessOptions& options, const Progress& progress) {
  const DeviceSpread& spread = nominal.scene.spread;
  Sensitivity found;
  for (const SpreadVariable& variable : spread.variables) found.variables.push_back(variable.name);
  if (spread.copula) found.why_none = "the varied quantities are correlated: their shares of the variance cannot be separated";
  if (spread.variables.size() < 2) found.why_none = "only one quantity varies, and causes all of the variance";
  if (!found.why_none.empty()) return found;
  const Ensemble ensemble(nominal, SobolDesign(PointSet::sobol, spread.variables.size(), options.seed, rows));
  const std::vector<DeviceOutcome> outcomes =
      close_all(ensemble, {internal::exactly_measured(nominal, drive)}, internal::run_of(nominal, options), progress).front();
  if (outcomes.size() < ensemble.size()) {
    found.why_none = "interrupted";
    return found;
  }
  for (const std::string_view key : explained_figures) {
    std::vector<double> figures;
    for (const DeviceOutcome& o : outcomes) figures.push_back(o.of(figure_of(key)));
    found.figures.push_back({.key = key, .estimate = sobol_indices(spread.variables.size(), figures)});
  }
  return found;
}

std::vector<DeviceCourse> device_courses(const PreparedScene& nominal, const DriveRobustness& drive, const Robustness& found,
                                         const RobustnessOptions& options) {
  std::vector<std::size_t> order(drive.outcomes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto height = [&](std::size_t k) { return drive.outcomes[k].of(figure_of(&Metrics::major_bounce_height)); };
  const auto speed = [&](std::size_t k) { return drive.outcomes[k].of(figure_of(&Metrics::largest_impact_velocity)); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return height(a) != height(b) ? height(a) < height(b) : speed(a) < speed(b);
  });
  std::vector<DeviceCourse> courses;
  for (const double probability : {0.05, 0.5, 0.95}) {
    if (order.empty()) break;
    const std::size_t k = order[static_cast<std::size_t>(std::lround(probability * static_cast<double>(order.size() - 1)))];
    try {
      const PreparedScene own = prepare(scene_of_device(nominal, drive, k, options).again("device.toml"));
      courses.push_back(
          {.probability = probability,
           .device = k,
           .trajectory = simulate_closing(own.model, own.signals(), {.duration = found.duration, .tolerance = found.tolerance})});
    } catch (const InvalidInput&) {
      continue;  // a device with impossible values has no motion
    }
  }
  return courses;
}

GapCourses gap_courses(const PreparedScene& nominal, const DriveRobustness& drive, std::size_t devices, std::size_t instants,
                       double end, const RobustnessOptions& options, const Progress& progress) {
  GapCourses courses{.end = end};
  std::vector<std::vector<double>> all(std::min(devices, drive.outcomes.size()));
  run_tasks(
      all.size(), options.jobs,
      [&](std::size_t k) {
        try {
          const PreparedScene own = prepare(scene_of_device(nominal, drive, k, options).again("device.toml"));
          const Trajectory closing = simulate_closing(
              own.model, own.signals(), {.duration = end, .tolerance = std::max(own.tolerance, EnsembleRun{}.tolerance)});
          all[k] = sampled_gap(closing, instants, end);
        } catch (const InvalidInput&) {  // a device with impossible values has no motion
        }
      },
      progress.stop);
  progress.throw_if_stopped();
  std::erase_if(all, [](const std::vector<double>& gap) { return gap.empty(); });
  courses.gaps = std::move(all);
  return courses;
}

SceneFile scene_of_device(const PreparedScene& nominal, const DriveRobustness& drive, std::size_t device,
                          const RobustnessOptions& options) {
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  return internal::scene_of_values(ensemble, drive, ensemble.values(device), options.seed, device);
}

double window_for(const PreparedScene& nominal, std::span<const Signal> commanded) {
  constexpr double slower = 0.1, periods = 2;
  const double last = last_breakpoint(commanded), own = nominal.duration;
  return std::max(own, last + periods * nominal.model.basis().in_contact_period() + (last > own ? slower * last : 0));
}

void set_window(SceneFile& file, double window) {
  file.assign("simulate.duration", Quantity{.value = window, .dimension = dimension::time});
}

double rounded_up(double window) {
  constexpr double rounding = 1e-12;  // a window of two digits, but for rounding errors, stays as it is
  const int place = static_cast<int>(std::floor(std::log10(window))) - 1;
  // Powers of ten with a positive exponent are exact, so that the quotient is the nearest double; 17 * 1e-4 is not.
  const double power = std::pow(10, std::abs(place));
  return place < 0 ? std::ceil(window * power * (1 - rounding)) / power : std::ceil(window / power * (1 - rounding)) * power;
}

namespace internal {
namespace {

// Returns the simulated time of the devices [s]: that which the scene gives, or one that holds its waveforms.
double window_of(const PreparedScene& nominal) {
  return nominal.scene.simulate.duration > 0 ? nominal.duration : window_for(nominal, nominal.commanded(nominal.waveforms()));
}

}  // namespace

DriveRobustness summarised(NamedDrive drive, MeasuredUnits known, std::vector<DeviceOutcome> outcomes) {
  DriveRobustness all{.name = std::move(drive.name),
                      .waveforms = std::move(drive.waveforms),
                      .known = std::move(known),
                      .outcomes = std::move(outcomes)};
  summarise(all);
  return all;
}

EnsembleRun run_of(const PreparedScene& nominal, const RobustnessOptions& options) {
  return {.duration = window_of(nominal),
          .tolerance = std::max(nominal.tolerance, EnsembleRun{}.tolerance),
          .seed = options.seed,
          .jobs = options.jobs,
          .vectors = options.vectors,
          .measures_drive_energy = options.measures_drive_energy,
          .opens_on_command = options.opens_on_command};
}

EnsembleDrive exactly_measured(const PreparedScene& nominal, const DriveRobustness& drive) {
  return {.waveforms = waveforms_of(nominal, {.name = drive.name, .waveforms = drive.waveforms}),
          .known = drive.known.without_errors()};
}

SceneFile scene_of_values(const Ensemble& ensemble, const DriveRobustness& drive, const std::vector<double>& values,
                          std::uint64_t seed, std::size_t device) {
  const PreparedScene& nominal = ensemble.nominal();
  SceneFile file = ensemble.scene(values);
  if (const double window = window_of(nominal); window > nominal.duration) set_window(file, window);
  DeviceUnits units;
  if (const Calibration& calibration = drive.known.calibration(); !calibration.is_empty()) {
    const SampledDevice sampled = DeviceBuilder(ensemble).device(values);
    if (sampled.model) {
      const PullInMeter meter(nominal, MeasuredQuantities::of(calibration));
      units = drive.known.of(meter.exact(*sampled.model), seed, device);
      if (!units.are_known()) units = {};
    }
    file.erase("calibration");  // the waveforms in the scene file are already scaled by the calibration
  }
  const DeviceDrives drives(nominal);
  const std::vector<DeviceDrives::Written> own =
      drives.written(waveforms_of(nominal, {.name = drive.name, .waveforms = drive.waveforms}), units, values);
  const std::vector<std::string> names = nominal.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string driver = "driver." + names[k];
    set_errors(file, driver, own[k].errors);
    if (!drive.waveforms.contains(names[k]) && !drives.has_errors(k)) continue;
    file.set_waveform(names[k], own[k].waveform);
    if (const std::optional<DriverLimits>& limits = nominal.drives[k].limits; limits)
      allow(file, driver, nominal.commanded(k, own[k].waveform), *limits);
  }
  return file;
}

}  // namespace internal
}  // namespace softland
