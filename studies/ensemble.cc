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

std::vector<double> Ensemble::point(std::uint64_t k) const {
  std::vector<double> u(nominal_->scene.spread.variables.size());
  point_(k, u);
  return u;
}

std::vector<double> Ensemble::values(std::uint64_t k) const {
  std::vector<double> values = point(k);
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

DeviceCloser::DeviceCloser(const Prepared& nominal, const std::vector<EnsembleDrive>& drives, const EnsembleRun& run,
                           const std::atomic<bool>* stop)
    : nominal_(&nominal),
      drives_(&drives),
      options_{.duration = run.duration, .tolerance = run.tolerance, .stop = stop},
      seed_(run.seed) {
  const auto any = [&](auto&& known) { return std::any_of(drives.begin(), drives.end(), known); };
  if (any([](const EnsembleDrive& d) { return !d.calibration.is_empty(); }))
    meter_.emplace(nominal, any([](const EnsembleDrive& d) { return d.calibration.pull_in_error.has_value(); }));
  for (const EnsembleDrive& drive : drives) nominal_signals_.push_back(signals_of(drive.waveforms));
}

std::vector<DeviceOutcome> DeviceCloser::operator()(const SampledDevice& device, std::uint64_t k) const {
  std::vector<DeviceOutcome> outcomes(drives_->size());
  DeviceUnits exact;
  if (meter_ && device.model) exact = meter_->exact(*device.model);
  const auto stopped = [&] { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); };
  for (std::size_t d = 0; d < outcomes.size() && !stopped(); ++d) {
    const EnsembleDrive& drive = (*drives_)[d];
    if (drive.calibration.is_empty() || !device.model) {
      outcomes[d] = close_device(device, nominal_signals_[d], nominal_->scene.metrics, options_);
    } else if (const DeviceUnits units = DeviceMeter::measured(exact, drive.calibration, seed_, k); std::isfinite(units.volts)) {
      outcomes[d] = close_device(device, signals_of(in_units(drive.waveforms, nominal_->scene.device, units)),
                                 nominal_->scene.metrics, options_);
    } else {
      outcomes[d].failure = "its pull-in voltage cannot be measured";
    }
  }
  return outcomes;
}

std::vector<std::vector<DeviceOutcome>> close_all(const Ensemble& ensemble, const std::vector<EnsembleDrive>& drives,
                                                  const EnsembleRun& run, const Watch& watch) {
  const DeviceCloser closer(ensemble.nominal(), drives, run, watch.stop);
  std::vector<std::vector<DeviceOutcome>> outcomes(drives.size(), std::vector<DeviceOutcome>(ensemble.size()));
  std::mutex telling;
  std::atomic<std::size_t> done = 0;
  const auto task = [&](std::size_t c) {
    DeviceBuilder builder(ensemble);
    for (std::size_t k = c * chunk; k < std::min<std::size_t>(ensemble.size(), (c + 1) * chunk) && !watch.stopped(); ++k) {
      std::vector<DeviceOutcome> of_device = closer(builder.device(k), k);
      for (std::size_t d = 0; d < drives.size(); ++d) outcomes[d][k] = std::move(of_device[d]);
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
