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
    for (const VariedKey& key : variable.keys) reads_anew_ = reads_anew_ || (!key.member && !key.drive);
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
    for (const VariedKey& key : spread.variables[i].keys) {
      if (!key.drive) file.assign(key.path, DeviceSpread::value(spread.variables[i], key, values[i]));
    }
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
      for (const VariedKey& key : variable.keys) {
        if (!key.drive) key.member(scratch_) = DeviceSpread::value(variable, key, sampled.values[i]);
      }
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
  const bool calibrated = any([](const EnsembleDrive& d) { return !d.calibration.is_empty(); });
  std::optional<DeviceMeter> meter;
  if (calibrated) meter.emplace(nominal, any([](const EnsembleDrive& d) { return d.calibration.pull_in_error.has_value(); }));
  const DeviceDrives own(nominal);
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
      const DeviceUnits units = DeviceMeter::measured(exact, drives[d].calibration, run.seed, k);
      if (!std::isfinite(units.volts)) {
        outcomes[d][k].failure = "its pull-in voltage cannot be measured";
      } else if (device.model && own.differ(units)) {
        outcomes[d][k] =
            close_device(device, own.signals(drives[d].waveforms, units, device.values), nominal.scene.metrics, options);
      } else {
        outcomes[d][k] = close_device(device, nominal_signals[d], nominal.scene.metrics, options);
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
