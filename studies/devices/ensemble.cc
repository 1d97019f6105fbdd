#include "studies/devices/ensemble.h"

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

namespace softland {
namespace {

// Number of devices of one task: enough to fill the SIMD lanes, few enough to notice an interruption soon.
constexpr std::size_t chunk = 128;

// Records the figures of the closings of several devices that are simulated together in SIMD lanes.
class LaneFigures final : public LandingObserver {
 public:
  explicit LaneFigures(const MetricsOptions& options) : figures_(options) {}
  void touch(const Touch& touch) override {
    course_.first_touch.take(touch.begin, touch.impact_velocity);
    figures_.touch(touch);
  }
  void rebound(double begin, double end, double height) override {
    course_.above = std::isnan(end);
    figures_.rebound({.begin = begin, .end = end, .height = height});
  }
  [[nodiscard]] DeviceOutcome outcome(const Switch& model, const EnsembleEnd& end) {
    course_.last_time = end.time;
    Trajectory run{.status = Status::done,
                   .contact_gap = model.contact_gap(),
                   .in_contact_period = model.basis().in_contact_period(),
                   .force = end.force,
                   .first_touch = end.first_touch,
                   .energy = {.source_work = end.drive_energy}};
    if (model.contacts() > 1) run.contacts.resize(model.contacts());
    return {.metrics = figures_.metrics(run, course_)};
  }

 private:
  LandingFigures figures_;
  LandingFigures::Course course_;
};

}  // namespace

Ensemble::Ensemble(const PreparedScene& nominal, std::uint64_t size, std::function<void(std::uint64_t, std::span<double>)> point)
    : nominal_(&nominal), size_(size), point_(std::move(point)), resolved_(nominal.resolved()) {
  require(!nominal.scene.spread.empty(), [&] {
    return fmt::format("{}: a [spread] section must say how devices differ (softland new writes one)", nominal.scene.file.name());
  });
  // Read the scene of each device again if a varied key determines further numbers: the length of a rigid plate follows from
  // its area and width.
  reads_anew_ = nominal.scene.device.structure.is_rigid();
  for (const SpreadVariable& variable : nominal.scene.spread.variables) {
    for (const VariedKey& key : variable.keys) reads_anew_ = reads_anew_ || (!key.member && !key.drive);
  }
}

Ensemble::Ensemble(const PreparedScene& nominal, std::uint64_t size, std::uint64_t seed, PointSet points)
    : Ensemble(nominal, size,
               [all = SamplePoints(points, std::max<std::size_t>(1, nominal.scene.spread.variables.size()), seed, Stream::spread,
                                   size)](std::uint64_t k, std::span<double> u) { all.point(k, u); }) {}

Ensemble::Ensemble(const PreparedScene& nominal, const SobolDesign& design)
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
    for (const VariedKey& key : spread.variables[i].keys) {
      if (key.drive) continue;
      file.assign(key.path,
                  Quantity{.value = DeviceSpread::value(spread.variables[i], key, values[i]), .dimension = key.measured_in},
                  key.element);
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
        sampled.refusal = fmt::format("{} {}", key.name(), rule);
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

void DeviceBuilder::describe(SampledDevice& device) {
  const PreparedScene& nominal = ensemble_->nominal();
  if (!ensemble_->reads_anew()) {
    for (std::size_t i = 0; i < device.values.size(); ++i) {
      const SpreadVariable& variable = nominal.scene.spread.variables[i];
      for (const VariedKey& key : variable.keys) {
        if (!key.drive) key.member(scratch_) = DeviceSpread::value(variable, key, device.values[i]);
      }
    }
    device.model.emplace(switch_like(scratch_.device, nominal.model, nominal.quadrature, nominal.quadrature_accuracy));
    return;
  }
  const Device own = read_scene(ensemble_->scene(device.values)).device;
  device.model.emplace(switch_like(own, nominal.model, nominal.quadrature, nominal.quadrature_accuracy));
}

double DeviceOutcome::of(const Figure& figure) const {
  const double value = closed() ? figure.value(metrics) : Metrics::unset;
  return std::isfinite(value) ? value : figure.worst;
}

DeviceOutcome close_device(const SampledDevice& device, const std::vector<Signal>& signals, const MetricsOptions& options,
                           const ClosingOptions& run) {
  if (!device.model) return {.metrics = {}, .failure = device.refusal};
  MetricsObserver observer(device.model->contact_gap(), options);
  const Trajectory end = observe_closing(*device.model, signals, run, observer);
  DeviceOutcome outcome{.metrics = observer.metrics(end)};
  if (outcome.metrics.status == Status::numerical_failure || outcome.metrics.status == Status::collapsed_at_rest)
    outcome.failure = end.message.empty() ? std::string(to_string(outcome.metrics.status)) : end.message;
  return outcome;
}

std::vector<DeviceOutcome> close_devices(std::span<const DeviceClosing> closings, const MetricsOptions& options,
                                         Vectors vectors) {
  std::vector<DeviceOutcome> outcomes(closings.size());
  std::vector<EnsembleClosing> in_lanes;
  std::vector<std::size_t> places;
  std::vector<LaneFigures> figures(closings.size(), LaneFigures(options));
  for (std::size_t i = 0; i < closings.size(); ++i) {
    const auto& [device, signals, gains, run, measures_drive_energy] = closings[i];
    if (vectors == Vectors::none || !device->model) continue;
    places.push_back(i);
    in_lanes.push_back({.model = &*device->model,
                        .drives = *signals,
                        .gains = gains,
                        .duration = run.duration,
                        .after_contact = run.after_contact,
                        .no_end_before = run.no_end_before,
                        .no_contact_before = run.no_contact_before,
                        .steady_force = run.steady_force,
                        .measures_drive_energy = measures_drive_energy,
                        .observer = &figures[i]});
  }
  std::vector<bool> done(closings.size(), false);
  if (!in_lanes.empty()) {
    const std::vector<EnsembleEnd> ends = close_in_lanes(in_lanes, closings.front().run.tolerance, vectors);
    for (std::size_t n = 0; n < ends.size(); ++n) {
      if (!ends[n].followed) continue;
      done[places[n]] = true;
      outcomes[places[n]] = figures[places[n]].outcome(*in_lanes[n].model, ends[n]);
    }
  }
  for (std::size_t i = 0; i < closings.size(); ++i) {
    if (done[i]) continue;
    const auto& [device, signals, gains, run, measures_drive_energy] = closings[i];
    std::vector<Signal> own;
    for (std::size_t k = 0; k < gains.size(); ++k) own.push_back(scaled((*signals)[k], gains[k]));
    outcomes[i] = close_device(*device, gains.empty() ? *signals : own, options, run);
  }
  return outcomes;
}

namespace {

// Marks a device that is at rest at the end of the simulated time as not settled if its hold levels do not keep it closed.
void judge_hold(DeviceOutcome& outcome, const Hold& hold) {
  Metrics& m = outcome.metrics;
  if (outcome.closed()) m.resistance = hold.resistance;
  if (!outcome.closed() || !m.settled || hold.is_held) return;
  outcome.is_held = m.settled = false;
  m.status = Status::not_settled;
  m.permanent_contact_time = m.bounce_time = Metrics::unset;
}

}  // namespace

std::vector<DeviceOutcome> close_driven(std::span<const DrivenDevice> devices, const MetricsOptions& options,
                                        const ClosingOptions& run, const std::optional<ClosedEquilibrium>& near,
                                        bool measures_drive_energy, Vectors vectors) {
  std::vector<DeviceClosing> closings;
  std::vector<Hold> holds;
  for (const auto& [device, signals, duration] : devices) {
    holds.push_back(device->model ? hold_of(*device->model, *signals, near) : Hold{});
    closings.push_back({.device = device, .signals = signals, .run = run, .measures_drive_energy = measures_drive_energy});
    closings.back().run.duration = duration;
    closings.back().run.steady_force = holds.back().steady_force(options);
  }
  std::vector<DeviceOutcome> outcomes = close_devices(closings, options, vectors);
  for (std::size_t i = 0; i < outcomes.size(); ++i) judge_hold(outcomes[i], holds[i]);
  return outcomes;
}

DeviceCloser::DeviceCloser(const PreparedScene& nominal, const std::vector<EnsembleDrive>& drives, const EnsembleRun& run,
                           const std::atomic<bool>* stop)
    : nominal_(&nominal),
      drives_(&drives),
      options_{.duration = run.duration, .tolerance = run.tolerance, .stop = stop},
      seed_(run.seed),
      vectors_(run.vectors),
      measures_drive_energy_(run.measures_drive_energy),
      device_drives_(nominal) {
  MeasuredQuantities quantities;
  bool is_measured = false;
  for (const EnsembleDrive& drive : drives) {
    quantities = quantities | MeasuredQuantities::of(drive.known.calibration());
    is_measured = is_measured || !drive.known.calibration().is_empty();
  }
  if (is_measured) meter_.emplace(nominal, quantities);
  for (const EnsembleDrive& drive : drives) {
    std::vector<Signal> signals = nominal.applied(drive.waveforms);
    nominal_commands_.push_back(run.opens_on_command ? open_command(nominal, signals) : std::nullopt);
    nominal_signals_.push_back(nominal_commands_.back() ? nominal_commands_.back()->held : std::move(signals));
    nominal_closed_.push_back(closed_equilibrium(nominal.model, hold_levels(nominal_signals_.back())));
  }
}

std::vector<std::vector<DeviceOutcome>> DeviceCloser::operator()(std::span<const SampledDevice> devices,
                                                                 std::uint64_t first) const {
  std::vector<DeviceUnits> exact(devices.size());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (meter_ && devices[i].model) exact[i] = meter_->exact(*devices[i].model);
  }
  std::vector<std::vector<DeviceOutcome>> outcomes(drives_->size(), std::vector<DeviceOutcome>(devices.size()));
  const auto stopped = [&] { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); };
  for (std::size_t d = 0; d < outcomes.size() && !stopped(); ++d) {
    const EnsembleDrive& drive = (*drives_)[d];
    std::vector<std::vector<Signal>> own(devices.size());
    std::vector<DrivenDevice> driven;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < devices.size(); ++i) {
      const std::vector<Signal>* signals = &nominal_signals_[d];
      const DeviceUnits units = devices[i].model ? drive.known.of(exact[i], seed_, first + i) : DeviceUnits{};
      if (!units.are_known()) {
        outcomes[d][i].failure = not_measured;
        continue;
      }
      if (devices[i].model && device_drives_.differ(units)) {
        own[i] = device_drives_.signals(drive.waveforms, units, devices[i].values);
        signals = &own[i];
      }
      double duration = options_.duration;
      if (nominal_commands_[d]) {
        const double begin = nominal_commands_[d]->time * units.time;
        if (signals == &own[i])
          std::ranges::transform(own[i], own[i].begin(), [&](const Signal& s) { return held_from(s, begin); });
        duration = std::min(duration, begin);
      }
      places.push_back(i);
      driven.push_back({.device = &devices[i], .signals = signals, .duration = duration});
    }
    std::vector<DeviceOutcome> closed =
        close_driven(driven, nominal_->scene.metrics, options_, nominal_closed_[d], measures_drive_energy_, vectors_);
    for (std::size_t n = 0; n < places.size(); ++n) outcomes[d][places[n]] = std::move(closed[n]);
  }
  return outcomes;
}

std::vector<std::vector<DeviceOutcome>> close_all(const Ensemble& ensemble, const std::vector<EnsembleDrive>& drives,
                                                  const EnsembleRun& run, const Progress& progress) {
  const DeviceCloser closer(ensemble.nominal(), drives, run, progress.stop);
  std::vector<std::vector<DeviceOutcome>> outcomes(drives.size(), std::vector<DeviceOutcome>(ensemble.size()));
  std::mutex telling;
  std::atomic<std::size_t> done = 0;
  const auto task = [&](std::size_t c) {
    DeviceBuilder builder(ensemble);
    const std::size_t first = c * chunk;
    std::vector<SampledDevice> devices;
    for (std::size_t k = first; k < std::min<std::size_t>(ensemble.size(), first + chunk); ++k)
      devices.push_back(builder.device(k));
    std::vector<std::vector<DeviceOutcome>> closed = closer(devices, first);
    for (std::size_t d = 0; d < drives.size(); ++d)
      std::move(closed[d].begin(), closed[d].end(), outcomes[d].begin() + static_cast<std::ptrdiff_t>(first));
    done += devices.size();
    const std::scoped_lock lock(telling);
    progress.tell("devices of the spread", static_cast<double>(done) / static_cast<double>(ensemble.size()));
  };
  const std::size_t chunks = (ensemble.size() + chunk - 1) / chunk;
  std::size_t complete = std::min<std::size_t>(ensemble.size(), chunk * run_tasks(chunks, run.jobs, task, progress.stop));
  // After an interruption some closings are missing or incomplete: return the devices before the first such closing.
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
