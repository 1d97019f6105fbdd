#include "studies/robustness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/require.h"
#include "sampling/confidence.h"
#include "sampling/statistics.h"
#include "studies/plain_step.h"

namespace softland {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t most_worst = 10;

double or_worst(const DeviceOutcome& o, double value) { return o.closed() && std::isfinite(value) ? value : infinite; }

template <auto member>
double of(const DeviceOutcome& o) {
  return or_worst(o, o.metrics.*member);
}

template <auto member>
EnsembleFigure figure() {
  const Figure& f = figure_of(member);
  return {.key = f.key, .name = f.name, .symbol = f.symbol, .unit = f.unit, .value = of<member>};
}

Yield yield_of(std::size_t devices, std::size_t all) {
  return {.devices = devices,
          .value = static_cast<double>(devices) / static_cast<double>(all),
          .interval = wilson_interval(devices, all)};
}

FigureStatistics statistics(const EnsembleFigure& figure, const std::vector<DeviceOutcome>& outcomes) {
  std::vector<double> all, finite;
  for (const DeviceOutcome& o : outcomes) {
    all.push_back(figure.value(o));
    if (std::isfinite(all.back())) finite.push_back(all.back());
  }
  FigureStatistics s{.devices = finite.size()};
  if (!finite.empty()) {
    s.mean = sample_mean(finite);
    s.standard_deviation = sample_standard_deviation(finite);
    s.skewness = sample_skewness(finite);
  }
  for (std::size_t i = 0; i < robustness_quantiles.size(); ++i)
    s.quantiles[i] = {.value = sample_quantile(all, robustness_quantiles[i]),
                      .interval = quantile_interval(all, robustness_quantiles[i])};
  return s;
}

void summarise(DriveRobustness& drive) {
  const std::vector<DeviceOutcome>& all = drive.outcomes;
  if (all.empty()) return;
  for (const EnsembleFigure& f : ensemble_figures()) drive.figures.push_back(statistics(f, all));
  const auto count = [&](auto&& holds) { return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), holds)); };
  drive.closing = yield_of(count([](const DeviceOutcome& o) { return o.closed(); }), all.size());
  drive.bounce_free = yield_of(
      count([](const DeviceOutcome& o) { return o.closed() && o.metrics.settled && o.metrics.bounce_count == 0; }), all.size());
  drive.worst.resize(all.size());
  std::iota(drive.worst.begin(), drive.worst.end(), std::size_t{0});
  const auto height = [&](std::size_t k) { return of<&Metrics::major_bounce_height>(all[k]); };
  const auto kept = static_cast<std::ptrdiff_t>(std::min(most_worst, all.size()));
  std::partial_sort(drive.worst.begin(), drive.worst.begin() + kept, drive.worst.end(),
                    [&](std::size_t a, std::size_t b) { return height(a) != height(b) ? height(a) > height(b) : a < b; });
  drive.worst.resize(static_cast<std::size_t>(kept));
}

std::vector<Signal> signals_of(const Prepared& nominal, const NamedDrive& drive) {
  const std::vector<std::string> names = nominal.drive_names();
  for (const auto& [name, waveform] : drive.waveforms) {
    require(std::find(names.begin(), names.end(), name) != names.end(),
            [&] { return fmt::format("{}: drives '{}', which the first scene does not have", drive.name, name); });
    const auto limits = nominal.drives.limits.find(name);
    if (limits == nominal.drives.limits.end()) continue;
    const std::string broken = violation(signal(waveform), limits->second);
    require(broken.empty(), [&] { return fmt::format("{}: drive '{}': {}", drive.name, name, broken); });
  }
  std::vector<Signal> signals;
  for (const std::string& name : names) {
    const auto found = drive.waveforms.find(name);
    signals.push_back(found == drive.waveforms.end() ? Signal() : signal(found->second));
  }
  return signals;
}

}  // namespace

const std::vector<EnsembleFigure>& ensemble_figures() {
  static const std::vector<EnsembleFigure> all{
      figure<&Metrics::initial_contact_time>(),
      figure<&Metrics::permanent_contact_time>(),
      figure<&Metrics::bounce_count>(),
      figure<&Metrics::major_bounce_height>(),
      figure<&Metrics::impact_velocity>(),
      {.key = "largest_impact_velocity_m_s",
       .name = "Largest impact speed",
       .symbol = "v_max",
       .unit = "m/s",
       .value = [](const DeviceOutcome& o) { return or_worst(o, o.largest_impact_velocity); }},
      figure<&Metrics::peak_contact_force>(),
      figure<&Metrics::impact_energy>()};
  return all;
}

Robustness robustness(const Prepared& nominal, const std::vector<NamedDrive>& drives, const RobustnessOptions& options,
                      const Watch& watch) {
  require(nominal.model.has_contact(), "robustness needs a [contact] section: without contact there is nothing to land on");
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  Robustness result{.duration = nominal.duration, .tolerance = std::max(nominal.tolerance, EnsembleRun{}.tolerance)};

  const std::vector<Electrode>& electrodes = nominal.scene.device.electrodes;
  const bool one_pulls =
      std::any_of(electrodes.begin(), electrodes.end(), [](const Electrode& e) { return e.side != Side::far; });
  NamedDrive plain{.name = "plain step", .waveforms = plain_step(nominal, one_pulls ? Actuator::both : Actuator::pzt)};
  plain.waveforms.insert(nominal.drives.waveforms.begin(), nominal.drives.waveforms.end());  // of the drives that do not step
  std::vector<NamedDrive> all;
  std::vector<std::vector<Signal>> signals;
  const auto add = [&](const NamedDrive& drive) {
    std::vector<Signal> own = signals_of(nominal, drive);
    const auto is_same = [&](const std::vector<Signal>& other) { return same_drives(own, other); };
    if (std::any_of(signals.begin(), signals.end(), is_same)) return;  // the scene's own drive may be the plain step
    all.push_back(drive);
    signals.push_back(std::move(own));
  };
  add(plain);
  for (const NamedDrive& drive : drives) add(drive);

  result.devices = options.samples;
  for (std::size_t i = 0; i < all.size() && !watch.stopped(); ++i) {
    const Watch share{.stop = watch.stop, .progress = [&](std::string_view what, double part) {
                        watch.tell(what, (static_cast<double>(i) + part) / static_cast<double>(all.size()));
                      }};
    result.drives.push_back(
        {.name = all[i].name,
         .waveforms = all[i].waveforms,
         .outcomes = close_all(ensemble, signals[i],
                               {.duration = result.duration, .tolerance = result.tolerance, .jobs = options.jobs}, share)});
    result.devices = std::min(result.devices, result.drives.back().outcomes.size());
  }
  if (result.drives.empty() || result.devices == 0) watch.throw_if_stopped();
  // All drives are judged by the same devices.
  result.interrupted = watch.stopped();
  for (DriveRobustness& drive : result.drives) {
    drive.outcomes.resize(result.devices);
    summarise(drive);
  }
  return result;
}

SceneFile scene_of_device(const Prepared& nominal, const DriveRobustness& drive, std::size_t device,
                          const RobustnessOptions& options) {
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  SceneFile file = ensemble.scene(ensemble.values(device));
  for (const auto& [name, waveform] : drive.waveforms) file.set_waveform(name, waveform);
  return file;
}

}  // namespace softland
