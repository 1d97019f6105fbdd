#include "studies/closing/certify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/require.h"
#include "studies/closing/effect_ablation.h"
#include "studies/closing/open_state.h"

namespace softland {
namespace {

// Error of a figure that a run and its judge (a more accurate run) have in common, so that their difference does not show it.
// Relative to the figure, per unit of the relative tolerance.
constexpr double shared = 0.01;
constexpr double parted = 0.1;  // relative difference of a rebound's heights in two runs above which the runs have diverged

// True if a figure is ill-conditioned. Imperceptible changes of the drive voltages (the runs of `cloud`) change such a figure
// visibly, or it exists in some of the runs only. `better` has the figures of the more accurate run.
bool ill_conditioned(const Figure& figure, const std::vector<Metrics>& cloud, const Metrics& own, const Metrics& better,
                     const MetricsOptions& options) {
  std::vector<double> values;
  for (const Metrics& m : cloud) values.push_back(figure.counted(m, options));
  // The values of the figure in `own` and `better` differ by the error of the looser tolerance, which is no sign of
  // ill-conditioning. Hence only the existence of the figure in these runs counts.
  const bool own_has = std::isfinite(figure.value(own)), better_has = std::isfinite(figure.value(better));
  const auto have = std::count_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); }) + own_has + better_has;
  if (have == 0 || cloud.empty()) return false;
  return have < static_cast<std::ptrdiff_t>(cloud.size() + 2) || ill_conditioned(spread(std::move(values)));
}

// Repeats the closing with changed pull-in voltages, since drives in units of them (Vsp, Vdp) change too. Returns the figures
// for each such electrode: with its pull-in voltages decreased by their errors, then increased. An error is a multiple of the
// change with a finer quadrature; that of the dynamic pull-in voltage includes the precision of its search.
std::vector<Metrics> at_other_pull_in(const PreparedScene& prepared, const Switch& fine, const SwitchOptions& quadrature,
                                      const ClosingOptions& options, const MetricsOptions& figures, const Progress& progress) {
  const Scene& written = prepared.effects ? prepared.effects->described : prepared.scene;
  std::vector<Metrics> found;
  for (const std::string& name : written.need_pull_in) {
    const auto& electrodes = written.device.electrodes;
    const auto at = std::find_if(electrodes.begin(), electrodes.end(), [&](const Electrode& e) { return e.name == name; });
    const auto k = static_cast<std::size_t>(at - electrodes.begin());
    const auto known = prepared.pull_in.find(name);
    // Skip an electrode with only voltage limits in units of its pull-in voltage: limits do not change the closing.
    if (known == prepared.pull_in.end()) continue;
    const Switch model(written.device, quadrature);
    const std::vector<double> bias = bias_of(written, k);
    const StaticPullIn statically = static_pull_in(model, k, bias);
    const DynamicPullIn dynamically = dynamic_pull_in(model, k, statically, bias, progress);
    const ElectrodePullIn& own = known->second;
    const double by_static = error_safety * std::abs(statically.voltage - own.statically.voltage);
    const double by_dynamic = error_safety * std::abs(dynamically.voltage - own.dynamically.voltage) +
                              dynamic_pull_in_precision * own.dynamically.voltage;
    for (const double sign : {-1.0, 1.0}) {
      std::map<std::string, PullInVoltages> units = prepared.voltage_units();
      units[name].static_pull_in += sign * by_static;
      units[name].dynamic_pull_in += sign * by_dynamic;
      PreparedScene moved = prepared;
      try {
        moved.drives = written.drives(units).of(prepared.drive_names());
        // Scene::drives() does not know the capacitances that load the voltage sources: copy them.
        for (std::size_t i = 0; i < moved.drives.size(); ++i) moved.drives[i].source.load = prepared.drives[i].source.load;
        // No figures: a drive exceeds a limit of its voltage source, or the finer quadrature finds no pull-in voltage.
      } catch (const InvalidInput&) {
        found.emplace_back();
        continue;
      }
      const std::vector<Signal> signals = moved.signals();
      std::vector<Signal> held = signals;
      if (std::isfinite(options.opens_at) && moved.start() == StartState::open)
        std::ranges::transform(held, held.begin(), [&](const Signal& one) { return held_from(one, options.opens_at); });
      const Hold hold = hold_of(fine, held);
      ClosingOptions own = options;
      own.steady_force = hold.steady_force(prepared.scene.metrics);
      Trajectory t = simulate_closing(fine, signals, own);
      set_rest(t, fine, held, hold);
      found.push_back(metrics(t, figures));
      set_open_figures(found.back(), t, fine, signals);
    }
  }
  return found;
}

// The rebounds of one run, with the impact velocity before each rebound.
struct ReboundSequence {
  std::vector<Rebound> rebounds;
  std::vector<double> impacts;  // impact velocity of the touch of the contact before each rebound [m/s]
};

ReboundSequence rebound_sequence(const Trajectory& run) {
  ReboundSequence c{.rebounds = rebounds(run), .impacts = {}};
  std::size_t touch = 0;
  for (const Rebound& r : c.rebounds) {
    while (touch + 1 < run.touches.size() && run.touches[touch + 1].begin <= r.begin) ++touch;
    c.impacts.push_back(touch < run.touches.size() ? run.touches[touch].impact_velocity : Metrics::unset);
  }
  return c;
}

}  // namespace

std::optional<GrazingRebound> grazing_rebound(std::span<const Trajectory> runs, const MetricsOptions& options) {
  std::vector<ReboundSequence> sequences;
  for (const Trajectory& run : runs) sequences.push_back(rebound_sequence(run));
  if (sequences.empty()) return std::nullopt;
  const ReboundSequence& first = sequences.front();
  const auto named = [&](std::size_t k, bool at_threshold) {
    const Rebound& r = first.rebounds[k];
    return GrazingRebound{.number = static_cast<int>(k) + 1,
                          .time = r.begin,
                          .height = r.height,
                          .impact_velocity = first.impacts[k],
                          .at_threshold = at_threshold};
  };
  // Returns the likely cause of the divergence: the touch with the smallest impact velocity among the first `count` touches,
  // which may be missing in some runs.
  const auto gentlest = [&](std::size_t count) {
    const auto found = std::min_element(first.impacts.begin(), first.impacts.begin() + static_cast<std::ptrdiff_t>(count));
    return named(static_cast<std::size_t>(found - first.impacts.begin()), false);
  };
  for (std::size_t k = 0; k < first.rebounds.size(); ++k) {
    const double own = first.rebounds[k].height;
    const bool counts = own > options.significant_rebound;
    bool apart = false, across = false;
    for (const ReboundSequence& other : sequences) {
      const double height = k < other.rebounds.size() ? other.rebounds[k].height : Metrics::unset;
      apart = apart || !(std::abs(height - own) <= parted * own);
      across = across || (height > options.significant_rebound) != counts;
    }
    if (apart) return gentlest(k + 1);
    if (across) return named(k, true);
  }
  const bool others_go_on = std::any_of(sequences.begin(), sequences.end(), [&](const ReboundSequence& other) {
    return other.rebounds.size() > first.rebounds.size();
  });
  if (!others_go_on || first.rebounds.empty()) return std::nullopt;
  return gentlest(first.rebounds.size());
}

Closing certify(const PreparedScene& prepared, const Progress& progress, int jobs) {
  Closing c = simulate(prepared, true, progress);
  if (!c.judge) return c;
  if (!c.judge->came_to_its_end) {
    c.warnings.emplace_back("the figures could not be certified: no second run to compare them with came to its end");
    return c;
  }
  const std::vector<Signal> signals = prepared.signals();
  // The judge is a second run of the closing, tighter or looser than the first. The tighter of the two runs is more accurate.
  const bool judge_is_better = c.judge->tolerance < c.tolerance;
  const SwitchOptions& quadrature = judge_is_better ? c.judge->quadrature : c.quadrature;
  const Switch fine(prepared.scene.device, quadrature);
  const ClosingOptions options{.duration = prepared.duration,
                               .tolerance = std::min(c.judge->tolerance, c.tolerance),
                               .steady_force = prepared.scene.metrics.steady_force * c.trajectory.hold_force,
                               .start = prepared.start(),
                               .opens_at = c.command ? c.command->time : std::numeric_limits<double>::infinity(),
                               .stop = progress.stop};
  const MetricsOptions figures = with_load(with_opening(prepared.scene.metrics, fine, signals, c.command), fine, prepared.start(),
                                           c.command ? c.command->held : signals);
  const Metrics& better = c.judge->metrics;
  const std::vector<Metrics> moved = at_other_pull_in(prepared, fine, quadrature, options, figures, progress);
  std::vector<Trajectory> cloud = perturbed_closings(fine, signals, options, {.jobs = jobs}, progress);
  if (progress.stopped()) {
    c.metrics.status = Status::interrupted;
    c.warnings.insert(c.warnings.begin(), "interrupted before the figures were certified");
    return c;
  }
  std::erase_if(cloud, [](const Trajectory& t) { return !came_to_its_end(t); });
  std::vector<Metrics> runs;
  for (Trajectory& t : cloud) {
    // Take the hold of the unperturbed run: the perturbed drive voltages hardly change the closed equilibrium.
    t.hold_force = c.trajectory.hold_force;
    t.is_held = c.trajectory.is_held;
    t.hold_capacitance = c.trajectory.hold_capacitance;
    t.hold_resistance = c.trajectory.hold_resistance;
    runs.push_back(metrics(t, figures));
    set_open_figures(runs.back(), t, fine, signals);
  }
  Certificate certificate{.ill_conditioned = {}, .grazing = {}, .runs = static_cast<int>(runs.size())};
  for (const Figure& figure : all_figures) {
    if (!figure.has_error()) continue;
    const double own = figure.value(c.metrics), other = figure.value(better);
    double error = error_safety * std::abs(own - other) + shared * c.tolerance * std::abs(own);
    const double unmoved = judge_is_better ? other : own;
    // Add the larger of the changes of the figure if a pull-in voltage is decreased, or increased, by its error.
    for (std::size_t i = 0; i + 1 < moved.size(); i += 2) {
      error += std::fmax(std::abs(figure.value(moved[i]) - unmoved), std::abs(figure.value(moved[i + 1]) - unmoved));
    }
    if (ill_conditioned(figure, runs, c.metrics, better, prepared.scene.metrics)) {
      std::vector<double> values;
      for (const Metrics& m : runs) values.push_back(figure.value(m));
      const Spread cloud_spread = spread(std::move(values));
      for (const double value : {cloud_spread.low, cloud_spread.high}) error = std::fmax(error, std::abs(own - value));
      certificate.ill_conditioned.push_back({figure, cloud_spread});
    }
    c.errors[figure] = figure.is_count() ? std::ceil(error - 0.5) : error;
  }
  allow_for_residual(c.errors, c.trajectory);
  if (!certificate.ill_conditioned.empty()) certificate.grazing = grazing_rebound(cloud, prepared.scene.metrics);
  c.certificate = std::make_shared<const Certificate>(std::move(certificate));
  return c;
}

}  // namespace softland
