#include "studies/ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include "base/executor.h"
#include "base/random.h"
#include "base/require.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "studies/search_space.h"

namespace softland {
namespace {

constexpr std::size_t chunk = 256;  // devices of one task

// Devices that classes are made of.
constexpr std::uint64_t reference_seed = random_bits(0, Stream::classes, 0);
std::size_t reference_size(const Calibration& calibration) {
  constexpr std::size_t fewest = 512, of_a_class = 8;
  return calibration.classes ? std::max(fewest, of_a_class * static_cast<std::size_t>(*calibration.classes)) : 0;
}

}  // namespace

Ensemble::Ensemble(const Prepared& nominal, std::uint64_t size, std::function<void(std::uint64_t, std::span<double>)> point)
    : nominal_(&nominal), size_(size), point_(std::move(point)), resolved_(resolved(nominal.scene, nominal.voltage_units())) {
  require(!nominal.scene.spread.empty(), [&] {
    return fmt::format("{}: there is no [spread]: nothing tells how devices differ (see softland new)",
                       nominal.scene.file.name());
  });
  reads_anew_ = nominal.scene.device.structure.kind == StructureKind::plate;  // its length follows its area and width
  for (const SpreadVariable& variable : nominal.scene.spread.variables) {
    for (const VariedKey& key : variable.keys) reads_anew_ = reads_anew_ || !key.member;
  }
}

Ensemble::Ensemble(const Prepared& nominal, std::uint64_t size, std::uint64_t seed, PointSet points)
    : Ensemble(nominal, size,
               [all = SamplePoints(points, std::max<std::size_t>(1, nominal.scene.spread.variables.size()), seed, Stream::spread,
                                   size)](std::uint64_t k, std::span<double> u) { all.point(k, u); }) {}

Ensemble::Ensemble(const Prepared& nominal, const SobolDesign& design)
    : Ensemble(nominal, design.evaluations(), [design](std::uint64_t k, std::span<double> u) { design.point(k, u); }) {}

std::vector<double> Ensemble::values(std::uint64_t k) const {
  std::vector<double> values(nominal_->scene.spread.variables.size());
  point_(k, values);
  nominal_->scene.spread.to_values(values);
  return values;
}

SceneFile Ensemble::scene(const std::vector<double>& values) const {
  SceneFile file = resolved_;
  file.erase("spread");
  const DeviceSpread& spread = nominal_->scene.spread;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const VariedKey& key : spread.variables[i].keys)
      file.assign(key.path, DeviceSpread::value(spread.variables[i], key, values[i]));
  }
  return file;
}

SampledDevice DeviceBuilder::device(std::vector<double> values) {
  SampledDevice sampled{.values = std::move(values), .model = {}, .refusal = {}};
  for (std::size_t i = 0; i < sampled.values.size(); ++i) {
    const SpreadVariable& variable = ensemble_->nominal().scene.spread.variables[i];
    for (const VariedKey& key : variable.keys) {
      if (const std::string rule = key.refusal(DeviceSpread::value(variable, key, sampled.values[i])); !rule.empty()) {
        sampled.refusal = fmt::format("{} {}", key.path, rule);
        return sampled;
      }
    }
  }
  try {
    describe(sampled);
  } catch (const InvalidInput& error) {
    sampled.model.reset();
    sampled.refusal = error.what();
  }
  return sampled;
}

void DeviceBuilder::describe(SampledDevice& sampled) {
  const Prepared& nominal = ensemble_->nominal();
  if (!ensemble_->reads_anew()) {
    for (std::size_t i = 0; i < sampled.values.size(); ++i) {
      const SpreadVariable& variable = nominal.scene.spread.variables[i];
      for (const VariedKey& key : variable.keys) key.member(scratch_) = DeviceSpread::value(variable, key, sampled.values[i]);
    }
    sampled.model.emplace(scratch_.device, nominal.quadrature, &nominal.model);
    return;
  }
  sampled.model.emplace(read_scene(ensemble_->scene(sampled.values)).device, nominal.quadrature, &nominal.model);
}

DeviceMeter::DeviceMeter(const Prepared& nominal, bool need_pull_in) : nominal_(&nominal), need_pull_in_(need_pull_in) {
  if (!need_pull_in) return;
  require(has_pulling_electrode(nominal.scene.device), [&] {
    return fmt::format("{}: Vdp cannot be measured: there is no electrode that pulls in", nominal.scene.file.name());
  });
  const std::string name = searched_electrode(nominal.scene.device);
  const std::vector<std::string> names = nominal.drive_names();
  electrode_ = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  pull_in_ = pull_in(nominal.model);
  require(std::isfinite(pull_in_), [&] { return fmt::format("electrode '{}' has no pull-in voltage to calibrate by", name); });
}

double DeviceMeter::frequency() const { return nominal_->model.angular_frequencies()[0] / (2 * pi); }

double DeviceMeter::pull_in(const Switch& model) const {
  constexpr double tolerance = 1e-6;  // of the integrator: no measurement is as good
  return dynamic_pull_in(model, electrode_, static_pull_in(model, electrode_), {}, tolerance).voltage;
}

DeviceUnits DeviceMeter::exact(const Switch& model) const {
  return {.volts = need_pull_in_ ? pull_in(model) / pull_in_ : 1,
          .time = nominal_->model.angular_frequencies()[0] / model.angular_frequencies()[0]};
}

DeviceUnits DeviceMeter::measured(const DeviceUnits& exact, const Calibration& calibration, std::uint64_t seed, std::uint64_t k) {
  const auto reading = [&](double error, std::uint64_t which) {
    constexpr double least = 0.1;  // no instrument reads less than nothing
    return std::max(least, 1 + error * random_normal(seed, Stream::measurement, 2 * k + which));
  };
  DeviceUnits units;
  if (calibration.pull_in_error) units.volts = exact.volts * reading(*calibration.pull_in_error, 0);
  if (calibration.frequency_error) units.time = exact.time / reading(*calibration.frequency_error, 1);
  return units;
}

namespace {

// Without error.
std::vector<DeviceUnits> reference_units(const Prepared& nominal, bool need_pull_in, std::size_t size, int jobs,
                                         const Watch& watch) {
  const DeviceMeter meter(nominal, need_pull_in);
  const Ensemble ensemble(nominal, size, reference_seed);
  std::vector<DeviceUnits> units(ensemble.size());
  std::atomic<std::size_t> done = 0;
  std::mutex telling;
  constexpr std::size_t together = 16;
  const std::size_t chunks = (size + together - 1) / together;
  const auto task = [&](std::size_t c) {
    DeviceBuilder builder(ensemble);
    for (std::size_t k = c * together; k < std::min(size, (c + 1) * together) && !watch.stopped(); ++k) {
      const SampledDevice device = builder.device(k);
      units[k] = device.model ? meter.exact(*device.model) : DeviceUnits{.volts = Metrics::unset, .time = Metrics::unset};
    }
    const std::scoped_lock lock(telling);
    watch.tell("devices that classes are made of", static_cast<double>(++done) / static_cast<double>(chunks));
  };
  run_tasks(chunks, jobs, task, watch.stop);
  watch.throw_if_stopped();
  return units;
}

// Relative errors of volts and time count alike.
PlanePoint logarithms(const DeviceUnits& units) { return {std::log(units.volts), std::log(units.time)}; }
DeviceUnits units_at(const PlanePoint& point) { return {.volts = std::exp(point[0]), .time = std::exp(point[1])}; }

}  // namespace

KnownUnits::KnownUnits(const Calibration& calibration, std::span<const DeviceUnits> reference) : calibration_(calibration) {
  if (!calibration.classes) return;
  std::vector<PlanePoint> points;
  for (std::size_t k = 0; k < std::min(reference.size(), reference_size(calibration)); ++k) {
    const PlanePoint point = logarithms(DeviceMeter::measured(reference[k], calibration, reference_seed, k));
    if (std::isfinite(point[0]) && std::isfinite(point[1])) points.push_back(point);
  }
  require(!points.empty(), "no device of the spread can be measured: there is nothing to sort into classes");
  classes_ = classes_of(points, static_cast<std::size_t>(*calibration.classes), reference_seed);
}

DeviceUnits KnownUnits::of(const DeviceUnits& exact, std::uint64_t seed, std::uint64_t k) const {
  return of(DeviceMeter::measured(exact, calibration_, seed, k));
}

DeviceUnits KnownUnits::of(const DeviceUnits& measured) const {
  if (classes_.centres.empty() || !std::isfinite(measured.volts)) return measured;
  return units_at(classes_.centres[classes_.nearest(logarithms(measured))]);
}

std::vector<KnownUnits::Class> KnownUnits::classes() const {
  std::vector<Class> all;
  for (std::size_t i = 0; i < classes_.centres.size(); ++i)
    all.push_back({.centre = units_at(classes_.centres[i]), .share = classes_.shares[i]});
  return all;
}

KnownUnits KnownUnits::without_errors() const {
  KnownUnits exact = *this;
  for (std::optional<double>* error : {&exact.calibration_.pull_in_error, &exact.calibration_.frequency_error}) {
    if (*error) *error = 0;
  }
  return exact;
}

std::vector<KnownUnits> known_units(const Prepared& nominal, std::span<const Calibration> calibrations, int jobs,
                                    const Watch& watch) {
  std::size_t size = 0;
  bool need_pull_in = false;
  for (const Calibration& one : calibrations) {
    size = std::max(size, reference_size(one));
    need_pull_in = need_pull_in || (one.classes && one.pull_in_error);
  }
  std::vector<DeviceUnits> reference;
  if (size > 0) reference = reference_units(nominal, need_pull_in, size, jobs, watch);
  std::vector<KnownUnits> known;
  for (const Calibration& one : calibrations) known.emplace_back(one, reference);
  return known;
}

std::vector<Waveform> in_units(const std::vector<Waveform>& waveforms, const Device& device, const DeviceUnits& units) {
  std::vector<Waveform> own = waveforms;
  for (std::size_t k = 0; k < own.size(); ++k)
    own[k] = scaled(std::move(own[k]), k < device.electrodes.size() ? units.volts : 1, units.time);
  return own;
}

DeviceOutcome close_device(const SampledDevice& device, const std::vector<Signal>& signals, const MetricsOptions& options,
                           const ClosingOptions& run) {
  if (!device.model) return {.metrics = {}, .failure = device.refusal};
  MetricsObserver observer(device.model->device().gap.contact, options);
  const Trajectory end = observe_closing(*device.model, signals, run, observer);
  DeviceOutcome outcome{.metrics = observer.metrics(end), .largest_impact_velocity = observer.largest_impact_velocity()};
  if (outcome.metrics.status == Status::numerical_failure || outcome.metrics.status == Status::collapsed_at_rest)
    outcome.failure = end.message.empty() ? std::string(to_string(outcome.metrics.status)) : end.message;
  return outcome;
}

std::vector<std::vector<DeviceOutcome>> close_all(const Ensemble& ensemble, const std::vector<EnsembleDrive>& drives,
                                                  const EnsembleRun& run, const Watch& watch) {
  const Prepared& nominal = ensemble.nominal();
  const ClosingOptions options{.duration = run.duration, .tolerance = run.tolerance, .stop = watch.stop};
  const auto any = [&](auto&& known) { return std::any_of(drives.begin(), drives.end(), known); };
  const bool calibrated = any([](const EnsembleDrive& d) { return !d.known.calibration().is_empty(); });
  std::optional<DeviceMeter> meter;
  if (calibrated)
    meter.emplace(nominal, any([](const EnsembleDrive& d) { return d.known.calibration().pull_in_error.has_value(); }));
  std::vector<std::vector<Signal>> nominal_signals;
  for (const EnsembleDrive& drive : drives) nominal_signals.push_back(signals_of(drive.waveforms));

  std::vector<std::vector<DeviceOutcome>> outcomes(drives.size(), std::vector<DeviceOutcome>(ensemble.size()));
  std::mutex telling;
  std::atomic<std::size_t> done = 0;
  const auto close = [&](DeviceBuilder& builder, std::size_t k) {
    const SampledDevice device = builder.device(k);
    DeviceUnits exact;
    if (meter && device.model) exact = meter->exact(*device.model);
    for (std::size_t d = 0; d < drives.size() && !watch.stopped(); ++d) {
      const KnownUnits& known = drives[d].known;
      if (known.calibration().is_empty() || !device.model) {
        outcomes[d][k] = close_device(device, nominal_signals[d], nominal.scene.metrics, options);
      } else if (const DeviceUnits units = known.of(exact, run.seed, k); std::isfinite(units.volts)) {
        outcomes[d][k] = close_device(device, signals_of(in_units(drives[d].waveforms, nominal.scene.device, units)),
                                      nominal.scene.metrics, options);
      } else {
        outcomes[d][k].failure = "its pull-in voltage cannot be measured";
      }
    }
  };
  const auto task = [&](std::size_t c) {
    DeviceBuilder builder(ensemble);
    for (std::size_t k = c * chunk; k < std::min<std::size_t>(ensemble.size(), (c + 1) * chunk) && !watch.stopped(); ++k) {
      close(builder, k);
      if (++done % 64 != 0) continue;
      const std::scoped_lock lock(telling);
      watch.tell("devices of the spread", static_cast<double>(done) / static_cast<double>(ensemble.size()));
    }
  };
  const std::size_t chunks = (ensemble.size() + chunk - 1) / chunk;
  std::size_t complete = std::min<std::size_t>(ensemble.size(), chunk * run_tasks(chunks, run.jobs, task, watch.stop));
  // Asked to stop, some chunks hold devices that were not begun, or not ended.
  const auto missing = [](const DeviceOutcome& o) {
    return o.failure.empty() && (o.metrics.status == Status::not_run || o.metrics.status == Status::interrupted);
  };
  for (const auto& of_drive : outcomes) {
    const auto first = std::find_if(of_drive.begin(), of_drive.begin() + static_cast<std::ptrdiff_t>(complete), missing);
    complete = static_cast<std::size_t>(first - of_drive.begin());
  }
  for (auto& of_drive : outcomes) of_drive.resize(complete);
  return outcomes;
}

}  // namespace softland
