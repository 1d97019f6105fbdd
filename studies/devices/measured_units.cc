// Measurements on devices for a calibration: pull-in voltage, closing time, period and piezo, with errors, and the classes into
// which devices are sorted.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "base/executor.h"
#include "base/random.h"
#include "base/require.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "studies/closing/actuator.h"
#include "studies/closing/simulate.h"
#include "studies/devices/ensemble.h"

namespace softland {
namespace {

// Seed of the reference devices, from which the classes of a calibration are made.
constexpr std::uint64_t reference_seed = random_bits(0, Stream::classes, 0);
std::size_t reference_size(const Calibration& calibration) {
  constexpr std::size_t fewest = 512, of_a_class = 8;
  return calibration.classes ? std::max(fewest, of_a_class * static_cast<std::size_t>(*calibration.classes)) : 0;
}

// Returns the scale factors of each reference device (from which classes are made), without measurement error.
std::vector<DeviceUnits> reference_units(const PreparedScene& nominal, const MeasuredQuantities& quantities, std::size_t size,
                                         int jobs, const Progress& progress) {
  const PullInMeter meter(nominal, quantities);
  const Ensemble ensemble(nominal, size, reference_seed);
  std::vector<DeviceUnits> units(ensemble.size());
  std::atomic<std::size_t> done = 0;
  std::mutex telling;
  constexpr std::size_t together = 16;
  const std::size_t chunks = (size + together - 1) / together;
  const auto task = [&](std::size_t c) {
    DeviceBuilder builder(ensemble);
    for (std::size_t k = c * together; k < std::min(size, (c + 1) * together) && !progress.stopped(); ++k) {
      const SampledDevice device = builder.device(k);
      units[k] = device.model ? meter.exact(*device.model) : DeviceUnits{.volts = Metrics::unset, .time = Metrics::unset};
    }
    const std::scoped_lock lock(telling);
    progress.tell("devices from which classes are made", static_cast<double>(++done) / static_cast<double>(chunks));
  };
  run_tasks(chunks, jobs, task, progress.stop);
  progress.throw_if_stopped();
  return units;
}

// Returns the logarithms of a device's scale factors, in which equal relative errors of voltages and of time are equal
// distances.
SpacePoint logarithms(const DeviceUnits& units) { return {std::log(units.volts), std::log(units.time), std::log(units.piezo)}; }
DeviceUnits units_at(const SpacePoint& point) {
  return {.volts = std::exp(point[0]), .time = std::exp(point[1]), .piezo = std::exp(point[2])};
}

}  // namespace

double closing_time(const Switch& model, std::size_t drive, double step, Bias bias, double duration) {
  std::vector<Signal> signals;
  for (const double standing : bias) signals.push_back(Signal::standing(standing));
  signals[drive] = Signal::constant(step);
  return first_closing(model, signals, {.duration = duration, .tolerance = EnsembleRun{}.tolerance});
}

PullInMeter::PullInMeter(const PreparedScene& nominal, const MeasuredQuantities& quantities, double precision)
    : nominal_(&nominal), quantities_(quantities), precision_(precision) {
  require(!quantities.piezo || piezo_unit(nominal.model) > 0, [&] {
    return fmt::format("{}: piezo cannot be measured: {}", nominal.scene.file.name(),
                       nominal.model.has_piezo() ? "it does not move the contact point" : "there is no [piezo]");
  });
  if (!quantities.pull_in && !quantities.closing_time) return;
  require(has_pulling_electrode(nominal.scene.device), [&] {
    return fmt::format("{}: {} cannot be measured: there is no electrode that pulls in", nominal.scene.file.name(),
                       quantities.pull_in ? "Vdp" : "a closing time");
  });
  const std::string name = searched_electrode(nominal.scene.device);
  electrode_ = searched_drive(nominal.scene.device);
  pull_in_ = pull_in(nominal.model, std::min(precision, dynamic_pull_in_precision));
  require(std::isfinite(pull_in_), [&] { return fmt::format("electrode '{}' has no pull-in voltage to calibrate by", name); });
  if (quantities.closing_time) learn_times();
}

double PullInMeter::time_of(const Switch& model, double step) const {
  return softland::closing_time(model, electrode_, step, bias_of(nominal_->scene, electrode_), periods_to_close / frequency());
}

// Measures the closing times of the nominal device (pull-in voltage Vdp) under steps to closing_step Vdp / s, for voltage
// factors s of devices in [0.75, 1.19].
void PullInMeter::learn_times() {
  constexpr double least = 0.75, most = 1.19;
  constexpr int steps = 88;
  for (int n = 0; n <= steps; ++n) {
    const double volts = least + (most - least) * n / steps;
    const double time = time_of(nominal_->model, closing_step * pull_in_ / volts);
    if (std::isfinite(time) && (voltages_.empty() || time > voltages_.back().time))
      voltages_.push_back({.time = time, .volts = volts});
  }
  require(voltages_.size() > 2, [&] {
    return fmt::format("{}: no step to {} Vdp closes the switch: its closing time cannot be measured",
                       nominal_->scene.file.name(), closing_step);
  });
}

double PullInMeter::closing_time() const {
  return quantities_.closing_time ? time_of(nominal_->model, closing_step * pull_in_) : Metrics::unset;
}

// Interpolates the voltage factor linearly over the closing times of the nominal device under several steps; extrapolates too.
DeviceUnits PullInMeter::units_by_time(double time) const {
  if (!std::isfinite(time)) return {.volts = Metrics::unset, .time = 1};
  const auto above = std::ranges::upper_bound(voltages_, time, {}, &TimedVoltage::time);
  const auto next = std::clamp<std::ptrdiff_t>(above - voltages_.begin(), 1, static_cast<std::ptrdiff_t>(voltages_.size()) - 1);
  const TimedVoltage &a = voltages_[static_cast<std::size_t>(next - 1)], &b = voltages_[static_cast<std::size_t>(next)];
  const double slope = (b.volts - a.volts) / (b.time - a.time), volts = a.volts + slope * (time - a.time);
  return {.volts = volts, .time = 1, .volts_by_time = slope / volts};
}

double PullInMeter::piezo_unit(const Switch& model) { return std::abs(model.basis().piezo_deflection()) / model.contact_gap(); }

double PullInMeter::frequency() const { return nominal_->model.basis().angular_frequencies()[0] / (2 * pi); }

double PullInMeter::pull_in(const Switch& model, double precision) const {
  // Ratio of the integrator's tolerance to the precision of the pull-in voltage: measurements need no tighter integrator.
  constexpr double looser = 10;
  const std::vector<double> bias = bias_of(nominal_->scene, electrode_);
  const StaticPullIn statically = static_pull_in(model, electrode_, bias);
  return dynamic_pull_in(model, electrode_, statically, bias, {}, looser * precision, precision).voltage;
}

DeviceUnits PullInMeter::exact(const Switch& model) const {
  DeviceUnits units = quantities_.closing_time ? units_by_time(time_of(model, closing_step * pull_in_))
                      : quantities_.pull_in    ? DeviceUnits{.volts = pull_in(model, precision_) / pull_in_}
                                               : DeviceUnits{};
  units.time = nominal_->model.basis().angular_frequencies()[0] / model.basis().angular_frequencies()[0];
  if (const double unit = piezo_unit(nominal_->model); unit > 0) units.piezo = unit / piezo_unit(model);
  return units;
}

DeviceUnits PullInMeter::measured(const DeviceUnits& exact, const Calibration& calibration, std::uint64_t seed, std::uint64_t k) {
  // Lower bound of a measured factor, which a large measurement error must not make negative.
  constexpr double least_volts = 0.1;
  const auto reading = [&](double error, Stream stream, std::uint64_t counter) {
    return std::max(least_volts, 1 + error * random_normal(seed, stream, counter));
  };
  DeviceUnits units;
  if (calibration.pull_in_error) units.volts = exact.volts * reading(*calibration.pull_in_error, Stream::measurement, 2 * k);
  if (calibration.time_error)
    units.volts = std::max(least_volts, exact.volts * (1 + exact.volts_by_time * *calibration.time_error *
                                                               random_normal(seed, Stream::measurement, 2 * k)));
  if (calibration.frequency_error)
    units.time = exact.time / reading(*calibration.frequency_error, Stream::measurement, 2 * k + 1);
  if (calibration.piezo_error) units.piezo = exact.piezo / reading(*calibration.piezo_error, Stream::piezo_measurement, k);
  return units;
}

MeasuredUnits::MeasuredUnits(const Calibration& calibration, std::span<const DeviceUnits> reference) : calibration_(calibration) {
  if (!calibration.classes) return;
  std::vector<SpacePoint> points;
  for (std::size_t k = 0; k < std::min(reference.size(), reference_size(calibration)); ++k) {
    const SpacePoint point = logarithms(PullInMeter::measured(reference[k], calibration, reference_seed, k));
    if (is_finite(point)) points.push_back(point);
  }
  require(!points.empty(), "classes need devices that can be measured, and no device of the spread can");
  classes_ = classes_of(points, static_cast<std::size_t>(*calibration.classes), reference_seed);
}

DeviceUnits MeasuredUnits::of(const DeviceUnits& exact, std::uint64_t seed, std::uint64_t k) const {
  return of(PullInMeter::measured(exact, calibration_, seed, k));
}

DeviceUnits MeasuredUnits::of(const DeviceUnits& measured) const {
  if (classes_.centres.empty() || !measured.are_known()) return measured;
  return units_at(classes_.centres[classes_.nearest(logarithms(measured))]);
}

std::vector<MeasuredUnits::Class> MeasuredUnits::classes() const {
  std::vector<Class> all;
  for (std::size_t i = 0; i < classes_.centres.size(); ++i)
    all.push_back({.centre = units_at(classes_.centres[i]), .share = classes_.shares[i]});
  return all;
}

MeasuredUnits MeasuredUnits::without_errors() const {
  MeasuredUnits exact = *this;
  Calibration& all = exact.calibration_;
  for (std::optional<double>* error : {&all.pull_in_error, &all.frequency_error, &all.piezo_error, &all.time_error}) {
    if (*error) *error = 0;
  }
  return exact;
}

std::vector<MeasuredUnits> measured_units(const PreparedScene& nominal, std::span<const Calibration> calibrations, int jobs,
                                          const Progress& progress) {
  // Scale factors of the reference devices. The key is true for a measured closing time, which gives other voltage factors than
  // a measured Vdp.
  std::map<bool, std::vector<DeviceUnits>> references;
  for (const bool by_time : {false, true}) {
    std::size_t size = 0;
    MeasuredQuantities quantities;
    for (const Calibration& one : calibrations) {
      if (one.time_error.has_value() != by_time) continue;
      size = std::max(size, reference_size(one));
      if (one.classes) quantities = quantities | MeasuredQuantities::of(one);
    }
    if (size > 0) references[by_time] = reference_units(nominal, quantities, size, jobs, progress);
  }
  std::vector<MeasuredUnits> known;
  for (const Calibration& one : calibrations) known.emplace_back(one, references[one.time_error.has_value()]);
  return known;
}

DeviceUnits deviation_of_units(const PreparedScene& nominal, bool need_pull_in, int jobs, const Progress& progress) {
  // Number of simulated devices, which gives the standard deviations of the scale factors within 6 %.
  constexpr std::size_t devices = 128;
  DeviceUnits squares{.volts = 0, .time = 0, .piezo = 0};
  double known = 0;
  for (const DeviceUnits& one : reference_units(nominal, {.pull_in = need_pull_in}, devices, jobs, progress)) {
    if (!one.are_known() || !std::isfinite(one.time)) continue;
    ++known;
    squares.volts += (one.volts - 1) * (one.volts - 1);
    squares.time += (one.time - 1) * (one.time - 1);
    squares.piezo += (one.piezo - 1) * (one.piezo - 1);
  }
  return {.volts = std::sqrt(squares.volts / known),
          .time = std::sqrt(squares.time / known),
          .piezo = std::sqrt(squares.piezo / known)};
}

}  // namespace softland
