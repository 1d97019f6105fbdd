#include "studies/search/robust_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/executor.h"
#include "base/random.h"
#include "model/constants.h"
#include "sampling/confidence.h"
#include "sampling/risk.h"
#include "sampling/statistics.h"
#include "studies/closing/simulate.h"
#include "studies/devices/robustness.h"

namespace softland {
namespace {

constexpr double worst_score = RobustCost::not_closed;
constexpr double weight_of_time = 0.02, weight_of_scores = 0.1, weight_of_violation = 10;
constexpr double most_violation = 10;

double value_of(const DeviceOutcome& outcome, const Condition& condition) { return outcome.of(condition.figure); }

// Relative accuracy of the quadrature in closings that only rank candidate waveforms; the final evaluation has that of the
// scene.
constexpr double ranking_accuracy = 1e-4;

PreparedScene for_ranking(const PreparedScene& given) {
  PreparedScene coarse = given;
  ResolvedSwitch ranking = resolved_switch(given.scene.device, ranking_accuracy);
  if (ranking.model.quadrature().points() >= given.model.quadrature().points()) return coarse;
  coarse.model = std::move(ranking.model);
  coarse.quadrature = ranking.quadrature;
  coarse.quadrature_accuracy = ranking_accuracy;
  return coarse;
}

constexpr int repetitions = 400;
constexpr double compared_at = 0.95, confidence = 0.95;

std::vector<double> values_of(std::string_view key, const std::vector<DeviceOutcome>& outcomes, double least) {
  std::vector<double> all;
  for (const DeviceOutcome& o : outcomes) all.push_back(std::max(o.of(figure_of(key)), least));
  return all;
}

// True if the 95th percentile (compared_at) of a figure over devices is larger in `own` than in `of_step`; values may be
// infinite.
bool is_above(const std::vector<double>& own, const std::vector<double>& of_step) {
  return sample_quantile(own, compared_at) > sample_quantile(of_step, compared_at);
}

bool is_worse(const std::vector<double>& own, const std::vector<double>& of_step, std::uint64_t seed) {
  if (!is_above(own, of_step)) return false;
  std::size_t above = 0;
  std::vector<double> a(own.size()), b(own.size());
  for (int r = 0; r < repetitions; ++r) {
    for (std::size_t k = 0; k < own.size(); ++k) {
      const std::size_t row = internal::bootstrap_row(seed, static_cast<std::size_t>(r), k, own.size());
      a[k] = own[row], b[k] = of_step[row];
    }
    if (is_above(a, b)) ++above;
  }
  return static_cast<double>(above) > (1 - (1 - confidence) / 2) * repetitions;
}

}  // namespace

std::vector<Condition> beside_step(std::vector<Condition> conditions, std::span<const DeviceOutcome> of_step) {
  for (Condition& one : conditions) {
    if (!one.of_step) continue;
    std::vector<double> values;
    for (const DeviceOutcome& o : of_step) values.push_back(value_of(o, one));
    one = beside_step(std::move(one), sample_quantile(values, constrained_share));
  }
  return conditions;
}

bool fails(const DeviceOutcome& outcome) { return !outcome.closed() || !outcome.is_held; }

bool fulfils(const DeviceOutcome& outcome, const Condition& condition) { return condition.holds(value_of(outcome, condition)); }

Yield share_that_fulfils(std::span<const DeviceOutcome> outcomes, const Condition& condition) {
  const auto good = std::ranges::count_if(outcomes, [&](const DeviceOutcome& o) { return fulfils(o, condition); });
  return yield_of(static_cast<std::size_t>(good), outcomes.size());
}

bool hold(std::span<const Condition> conditions, std::span<const DeviceOutcome> outcomes) {
  return std::ranges::all_of(conditions,
                             [&](const Condition& one) { return share_that_fulfils(outcomes, one).value >= constrained_share; });
}

double waited(const DeviceOutcome& outcome, double Metrics::*figure) {
  if (fails(outcome)) return std::numeric_limits<double>::infinity();
  const double time = outcome.metrics.*figure;
  return std::isfinite(time) ? time : outcome.metrics.end;
}

double waited(std::span<const DeviceOutcome> outcomes, double Metrics::*figure) {
  std::vector<double> times;
  for (const DeviceOutcome& o : outcomes) times.push_back(waited(o, figure));
  return sample_quantile(times, constrained_share);
}

FreeTime free_time(std::span<const DeviceOutcome> of_step) {
  constexpr double never = std::numeric_limits<double>::infinity();
  constexpr double Metrics::*times_of_readiness[] = {&Metrics::steady_force_time, &Metrics::permanent_contact_time,
                                                     &Metrics::initial_contact_time};
  for (double Metrics::*const figure : times_of_readiness) {
    std::vector<double> times;
    for (const DeviceOutcome& o : of_step) {
      const double time = fails(o) ? never : o.metrics.*figure;
      times.push_back(std::isnan(time) ? never : time);
    }
    const double until = sample_quantile(times, constrained_share);
    if (std::isfinite(until)) return {.figure = figure, .until = until};
  }
  return {};
}

CalibratedEnsemble calibrate_all(const Ensemble& ensemble, const MeasuredQuantities& quantities, double precision, int jobs,
                                 const Progress& progress) {
  constexpr std::size_t together = 16;
  CalibratedEnsemble all{.devices = std::vector<SampledDevice>(ensemble.size()),
                         .exact = std::vector<DeviceUnits>(ensemble.size())};
  const PullInMeter meter(ensemble.nominal(), quantities, precision);
  const auto task = [&](std::size_t chunk) {
    DeviceBuilder builder(ensemble);
    for (std::size_t k = chunk * together; k < std::min<std::size_t>(ensemble.size(), (chunk + 1) * together); ++k) {
      if (progress.stopped()) return;
      all.devices[k] = builder.device(k);
      if (all.devices[k].model) all.exact[k] = meter.exact(*all.devices[k].model);
    }
  };
  run_tasks((ensemble.size() + together - 1) / together, jobs, task, progress.stop);
  progress.throw_if_stopped();
  return all;
}

BuiltEnsemble known_as(CalibratedEnsemble calibrated, const MeasuredUnits& known, std::uint64_t seed) {
  BuiltEnsemble built{.devices = std::move(calibrated.devices), .units = std::vector<DeviceUnits>(calibrated.exact.size())};
  if (known.calibration().is_empty()) return built;
  for (std::size_t k = 0; k < built.devices.size(); ++k) {
    SampledDevice& device = built.devices[k];
    if (!device.model) continue;
    built.units[k] = known.of(calibrated.exact[k], seed, k);
    if (built.units[k].are_known()) continue;
    device.refusal = not_measured;
    device.model.reset();
  }
  return built;
}

BuiltEnsemble build_all(const Ensemble& ensemble, const MeasuredUnits& known, std::uint64_t seed, int jobs,
                        const Progress& progress) {
  return known_as(calibrate_all(ensemble, MeasuredQuantities::of(known.calibration()), compared_precision, jobs, progress), known,
                  seed);
}

BuiltEnsemble own_devices(const SearchSetting& setting, const MeasuredUnits& known, std::uint64_t count, std::uint64_t seed,
                          std::uint64_t which, int jobs, const Progress& progress) {
  const std::uint64_t own = random_bits(seed, Stream::fresh, which);
  const PreparedScene nominal = for_ranking(setting.given);
  return build_all(Ensemble(nominal, count, own), known, own, jobs, progress);
}

RobustCost::RobustCost(const SearchSetting& setting, const RobustAim& aim, BuiltEnsemble ensemble, Vectors vectors)
    : setting_(setting), aim_(aim), ensemble_(std::move(ensemble)), drives_(setting.given), vectors_(vectors) {
  const Switch& model = setting.given.model;
  const double period = 2 * pi / model.basis().angular_frequencies()[0], in_contact = model.basis().in_contact_period();
  find_gains();
  window_ = std::max(0.6 * period, 2.5 * in_contact);
  tail_ = in_contact;
  wait_ = std::max(setting.run.no_contact_before, period);
  const std::vector<Signal> step = setting.baseline_scene.signals();
  levels_ = hold_levels(step);
  nominal_closed_ = closed_equilibrium(model, levels_);
  if (!keeps_closed(model, nominal_closed_)) nominal_closed_.reset();
  step_ = close_device({.values = {}, .model = model, .refusal = {}}, step, setting.given.scene.metrics,
                       {.duration = last_breakpoint(step) + wait_ + window_,
                        .tolerance = EnsembleRun{}.tolerance,
                        .after_contact = window_,
                        .steady_force = setting.run.steady_force});
  const std::vector<Waveform> plain = setting.drives({});
  for (std::size_t k = 0; k < devices(); ++k)
    kept_.push_back(ensemble_.devices[k].model ? kept(k, signals(plain, k, ensemble_.units[k])) : Kept());
  if (step_.closed()) return;
  const Metrics& nominal_step = setting.scale.step;
  const double drive_energy = step_.metrics.drive_energy;
  step_ = {};
  step_.metrics.drive_energy = drive_energy;
  step_.metrics.largest_impact_velocity = nominal_step.largest_impact_velocity;
  step_.metrics.initial_contact_time = nominal_step.initial_contact_time;
  step_.metrics.major_bounce_height = nominal_step.major_bounce_height;
}

std::vector<Signal> RobustCost::signals(const std::vector<Waveform>& waveforms, std::size_t k, const DeviceUnits& units) const {
  return drives_.differ(units) ? drives_.signals(waveforms, units, ensemble_.devices[k].values)
                               : setting_.given.applied(waveforms);
}

// Computes the gains of every device's voltage sources, which are constant factors on their voltages. If the drive signals of
// devices differ by gains alone, they are prepared once for all devices, since a sampled waveform has many breakpoints.
void RobustCost::find_gains() {
  if (std::ranges::none_of(ensemble_.units, [&](const DeviceUnits& units) { return drives_.differ(units); })) return;
  ungained_levels_ = hold_levels(drives_.without_gains(setting_.drives({})));
  gains_.emplace();
  for (std::size_t k = 0; k < devices(); ++k) {
    const SampledDevice& device = ensemble_.devices[k];
    std::optional<std::vector<double>> own =
        device.model ? drives_.gains(ensemble_.units[k], device.values) : std::vector<double>();
    if (!own) return gains_.reset();
    gains_->push_back(*std::move(own));
  }
}

// Returns the closed state of device k under the hold levels of `signals`. is_held is true for every device if not even the
// nominal device stays closed: the search must then not penalise open devices.
RobustCost::Kept RobustCost::kept(std::size_t k, const std::vector<Signal>& signals) const {
  const Hold hold = hold_of(*ensemble_.devices[k].model, signals, nominal_closed_);
  return {.is_held = !nominal_closed_ || hold.is_held,
          .steady_force = hold.steady_force(setting_.given.scene.metrics),
          .resistance = hold.resistance};
}

std::vector<DeviceOutcome> RobustCost::close(const std::vector<Waveform>& waveforms, std::size_t first, std::size_t last,
                                             int jobs) const {
  return close(waveforms, first, last, window_, jobs);
}

std::vector<DeviceOutcome> RobustCost::close(const std::vector<Waveform>& waveforms, std::size_t first, std::size_t last,
                                             double after_contact, int jobs) const {
  constexpr std::size_t together = 64;  // number of devices that one parallel task simulates
  std::vector<Signal> nominal = gains_ ? drives_.without_gains(waveforms) : setting_.given.applied(waveforms);
  const bool same_levels = hold_levels(nominal) == (gains_ ? ungained_levels_ : levels_), by_gains = gains_ && same_levels;
  if (gains_ && !by_gains) nominal = setting_.given.applied(waveforms);
  std::vector<DeviceOutcome> outcomes(last - first);
  run_tasks((outcomes.size() + together - 1) / together, jobs, [&](std::size_t task) {
    const std::size_t begin = task * together, end = std::min(outcomes.size(), begin + together);
    std::vector<std::vector<Signal>> own(end - begin);
    std::vector<DeviceClosing> closings;
    std::vector<Kept> kept_here;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t k = first + i;
      const SampledDevice& device = ensemble_.devices[k];
      const DeviceUnits& units = ensemble_.units[k];
      std::vector<Signal>& of_device = own[i - begin];
      if (device.model && drives_.differ(units) && !by_gains) of_device = drives_.signals(waveforms, units, device.values);
      const std::vector<Signal>& signals = of_device.empty() ? nominal : of_device;
      kept_here.push_back(same_levels || !device.model ? kept_[k] : kept(k, signals));
      ClosingOptions own_run = run(signals, kept_here.back().steady_force);
      own_run.after_contact = after_contact;
      own_run.duration += after_contact - window_;
      closings.push_back({.device = &device,
                          .signals = &signals,
                          .gains = by_gains ? (*gains_)[k] : std::vector<double>(),
                          .run = own_run,
                          .measures_drive_energy = setting_.target.measures_drive_energy()});
    }
    std::vector<DeviceOutcome> closed = close_devices(closings, setting_.given.scene.metrics, vectors_);
    for (std::size_t i = 0; i < closed.size(); ++i) {
      if (!closed[i].closed()) continue;
      closed[i].is_held = kept_here[i].is_held;
      closed[i].metrics.resistance = kept_here[i].resistance;
    }
    std::move(closed.begin(), closed.end(), outcomes.begin() + static_cast<std::ptrdiff_t>(begin));
  });
  return outcomes;
}

std::vector<DeviceOutcome> RobustCost::close_by_step(int jobs) const {
  constexpr int most_doublings = 3;
  const std::vector<Waveform> plain = setting_.drives({});
  std::vector<DeviceOutcome> outcomes;
  double after_contact = std::max(setting_.given.duration, window_);
  for (int n = 0; n <= most_doublings; ++n, after_contact *= 2) {
    outcomes = close(plain, 0, devices(), after_contact, jobs);
    const FreeTime found = free_time(outcomes);
    const bool is_about_force = std::ranges::any_of(kept_, [](const Kept& one) { return std::isfinite(one.steady_force); });
    if (found.until == 0 || found.figure == (is_about_force ? &Metrics::steady_force_time : &Metrics::permanent_contact_time))
      break;
  }
  return outcomes;
}

std::vector<DeviceOutcome> RobustCost::close_until(const std::vector<Waveform>& waveforms, double free, int jobs) const {
  return close(waveforms, 0, devices(), std::max({setting_.given.duration, window_, free}), jobs);
}

DeviceOutcome RobustCost::close(const std::vector<Waveform>& waveforms, std::size_t k, const DeviceUnits& units) const {
  const SampledDevice& device = ensemble_.devices[k];
  const std::vector<Signal> signals = drives_.signals(waveforms, units, device.values);
  const Kept own = device.model ? kept(k, signals) : Kept();
  DeviceOutcome outcome = close_device(device, signals, setting_.given.scene.metrics, run(signals, own.steady_force));
  if (outcome.closed()) outcome.metrics.resistance = own.resistance;
  return outcome;
}

ClosingOptions RobustCost::run(const std::vector<Signal>& signals, double steady_force) const {
  const double end = last_breakpoint(signals);
  return {.duration = end + wait_ + window_,
          .tolerance = EnsembleRun{}.tolerance,
          .after_contact = window_,
          .no_end_before = end + tail_,
          .no_contact_before = end + wait_,
          .steady_force = steady_force};
}

double RobustCost::score(const DeviceOutcome& outcome) const {
  if (fails(outcome)) return worst_score;
  const Shares shares{.own = outcome.metrics, .step = step_.metrics, .window = window_};
  const double score =
      setting_.target.mean(shares.own, shares.step, [&](const TargetRow& row) { return row.in(row.robust, shares); });
  return std::isnan(score) ? worst_score : score;
}

std::vector<double> RobustCost::scores(std::span<const DeviceOutcome> outcomes) const {
  std::vector<Metrics> closings;
  for (const DeviceOutcome& o : outcomes) {
    if (!fails(o)) closings.push_back(o.metrics);
  }
  const std::vector<double> means =
      setting_.target.means(closings, step_.metrics, [&](const TargetRow& row, const Metrics& closing) {
        return row.in(row.robust, {.own = closing, .step = step_.metrics, .window = window_});
      });
  std::vector<double> all;
  auto next = means.begin();
  for (const DeviceOutcome& o : outcomes) {
    const double score = fails(o) ? worst_score : *next++;
    all.push_back(std::isnan(score) ? worst_score : std::min(score, worst_score));
  }
  return all;
}

bool RobustCost::is_told(std::span<const DeviceOutcome> outcomes) const {
  constexpr double rounding = 1e-9;
  if (!aim_.measure.yield && aim_.measure.risk.kind == RiskKind::mean_sigma) return !std::ranges::all_of(outcomes, fails);
  return aim_.measure.yield ? share_that_fulfils(outcomes, *aim_.measure.yield).devices > 0
                            : risk(scores(outcomes), aim_.measure.risk) < (1 - rounding) * worst_score;
}

// Returns the measure of risk of the devices' scores (costs s_k). For mean+sigma the failing devices count separately: the
// standard deviation of all scores would decrease again if most devices fail.
double RobustCost::risk_of(std::span<const DeviceOutcome> outcomes, const std::vector<double>& scores, const Risk& measure) {
  if (measure.kind != RiskKind::mean_sigma || std::ranges::none_of(outcomes, fails)) return risk(scores, measure);
  std::vector<double> others;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    if (!fails(outcomes[k])) others.push_back(scores[k]);
  }
  const double own = others.size() < 2 ? worst_score : risk(others, measure);
  const double share = 1 - static_cast<double>(others.size()) / static_cast<double>(outcomes.size());
  return own + (1 + measure.parameter) * worst_score * std::sqrt(share);
}

double RobustCost::measured(std::span<const DeviceOutcome> outcomes, const std::vector<double>& scores, const RobustAim& aim) {
  if (!aim.measure.yield) return risk_of(outcomes, scores, aim.measure.risk);
  return 1 - share_that_fulfils(outcomes, *aim.measure.yield).value + weight_of_scores * sample_mean(scores);
}

double RobustCost::measured(std::span<const DeviceOutcome> outcomes, const RobustAim& aim) const {
  return measured(outcomes, scores(outcomes), aim);
}

double RobustCost::value(std::span<const DeviceOutcome> outcomes, const RobustAim& aim) const {
  const std::vector<double> scores = this->scores(outcomes);
  std::vector<double> times, of_devices;
  for (const DeviceOutcome& o : outcomes)
    times.push_back(o.closed() ? Shares::ratio(o.metrics.initial_contact_time, step_.metrics.initial_contact_time) : worst_score);
  double value = measured(outcomes, scores, aim);
  value += static_cast<double>(std::ranges::count_if(outcomes, fails)) / static_cast<double>(outcomes.size());
  const double late = std::isfinite(aim.free.until) ? std::max(0.0, waited(outcomes, aim.free.figure) / aim.free.until - 1) : 0;
  value += weight_of_time * std::min(sample_quantile(times, 0.5), late);
  for (const Condition& condition : aim.conditions) {
    of_devices.clear();
    for (const DeviceOutcome& o : outcomes)
      of_devices.push_back(std::min(condition.violation(value_of(o, condition)), most_violation));
    value += weight_of_violation * std::max(0.0, sample_quantile(of_devices, constrained_share));
  }
  return value;
}

std::vector<std::string_view> worse_in(const std::vector<DeviceOutcome>& drive, const std::vector<DeviceOutcome>& step,
                                       double significant, std::uint64_t seed) {
  std::vector<std::string_view> worse;
  // An interrupted simulation has fewer outcomes: compare the devices that both lists have.
  const std::size_t both = std::min(drive.size(), step.size());
  for (const std::string_view key : judged_figures) {
    const double least = key == key_of(&Metrics::major_bounce_height) ? significant : 0;
    std::vector<double> own = values_of(key, drive, least), of_step = values_of(key, step, least);
    own.resize(both), of_step.resize(both);
    if (both > 0 && is_worse(own, of_step, seed)) worse.push_back(key);
  }
  return worse;
}

std::vector<Condition> at_most_step(const std::vector<DeviceOutcome>& step, double significant) {
  std::vector<Condition> all;
  for (const std::string_view key : judged_figures) {
    const double least = key == key_of(&Metrics::major_bounce_height) ? significant : 0;
    const double limit = sample_quantile(values_of(key, step, least), compared_at);
    if (std::isfinite(limit))
      all.push_back({.figure = figure_of(key), .comparison = Comparison::at_most, .limit = limit, .text = ""});
  }
  return all;
}

}  // namespace softland
