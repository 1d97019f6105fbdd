#include "studies/ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "base/executor.h"
#include "base/require.h"
#include "model/closing.h"

namespace softland {
namespace {

constexpr std::size_t chunk = 256;  // devices of one task

DeviceOutcome close_one(const SampledDevice& device, const std::vector<Signal>& drives, const MetricsOptions& options,
                        const ClosingOptions& run) {
  if (!device.model) return {.metrics = {}, .failure = device.refusal};
  MetricsObserver observer(device.model->device().gap.contact, options);
  const Trajectory end = observe_closing(*device.model, drives, run, observer);
  DeviceOutcome outcome{.metrics = observer.metrics(end), .largest_impact_velocity = observer.largest_impact_velocity()};
  if (outcome.metrics.status == Status::numerical_failure || outcome.metrics.status == Status::collapsed_at_rest)
    outcome.failure = end.message.empty() ? std::string(to_string(outcome.metrics.status)) : end.message;
  return outcome;
}

}  // namespace

Ensemble::Ensemble(const Prepared& nominal, std::uint64_t size, std::uint64_t seed, PointSet points)
    : nominal_(&nominal),
      points_(points, std::max<std::size_t>(1, nominal.scene.spread.variables.size()), seed, Stream::spread, size),
      resolved_(resolved(nominal.scene, nominal.voltage_units())) {
  require(!nominal.scene.spread.empty(), [&] {
    return fmt::format("{}: there is no [spread]: nothing tells how devices differ (see softland new)",
                       nominal.scene.file.name());
  });
  reads_anew_ = nominal.scene.device.structure.kind == StructureKind::plate;  // its length follows its area and width
  for (const SpreadVariable& variable : nominal.scene.spread.variables) {
    for (const VariedKey& key : variable.keys) reads_anew_ = reads_anew_ || !key.member;
  }
}

std::vector<double> Ensemble::values(std::uint64_t k) const {
  std::vector<double> values(points_.dimensions());
  points_.point(k, values);
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

std::vector<DeviceOutcome> close_all(const Ensemble& ensemble, const std::vector<Signal>& drives, const EnsembleRun& run,
                                     const Watch& watch) {
  std::vector<DeviceOutcome> outcomes(ensemble.size());
  const ClosingOptions options{.duration = run.duration, .tolerance = run.tolerance, .stop = watch.stop};
  std::mutex telling;
  std::atomic<std::size_t> done = 0;
  const std::size_t chunks = (outcomes.size() + chunk - 1) / chunk;
  const auto task = [&](std::size_t c) {
    DeviceBuilder builder(ensemble);
    for (std::size_t k = c * chunk; k < std::min(outcomes.size(), (c + 1) * chunk) && !watch.stopped(); ++k) {
      outcomes[k] = close_one(builder.device(k), drives, ensemble.nominal().scene.metrics, options);
      if (++done % 64 != 0) continue;
      const std::scoped_lock lock(telling);
      watch.tell("devices of the spread", static_cast<double>(done) / static_cast<double>(outcomes.size()));
    }
  };
  outcomes.resize(std::min(outcomes.size(), chunk * run_tasks(chunks, run.jobs, task, watch.stop)));
  // Asked to stop, some chunks hold devices that were not begun, or not ended.
  const auto missing = std::find_if(outcomes.begin(), outcomes.end(), [](const DeviceOutcome& o) {
    return o.failure.empty() && (o.metrics.status == Status::not_run || o.metrics.status == Status::interrupted);
  });
  outcomes.erase(missing, outcomes.end());
  return outcomes;
}

}  // namespace softland
