#include "studies/closing/auto_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/engineering.h"
#include "model/closing.h"
#include "model/constants.h"
#include "objectives/figures.h"
#include "studies/closing/closing_progress.h"
#include "studies/closing/prepared.h"
#include "studies/closing/static_excess.h"

namespace softland {
namespace {

constexpr double run_tolerance = 1e-6;  // of the integrator: errors far below auto_modes_tolerance
constexpr double least_share = 0.01;    // of what a closing is like, below which a figure is as good as zero

struct Judged {
  double value, scale;
};

struct Judgement {
  std::vector<Judged> figures;
  std::vector<double> static_pull_in;  // of every electrode [V]
};

Judgement judged(const SceneFile& file, int modes, const Watch& watch) {
  SceneFile with = file;
  with.assign("structure.modes", modes);
  with.assign("simulate.effects",
              std::string("all"));  // every number of modes is judged on the same effects; they are chosen after
  const PreparedScene p = prepare(with, false, watch);
  const double omega = p.model.basis().angular_frequencies()[0], gap = p.scene.device.gap.contact;
  const Trajectory t = simulate_closing(p.model, p.signals(),
                                        {.duration = p.duration,
                                         .tolerance = std::max(run_tolerance, p.tolerance),
                                         .after_contact = 2 * pi / omega,
                                         .stop = watch.stop,
                                         .observer = observer(watch, fmt::format("closing with {} modes", modes), p.duration)});
  watch.throw_if_stopped();
  const Metrics m = metrics(t, p.scene.metrics);
  FigureValues scale;
  scale[&Metrics::initial_contact_time] = 1 / omega;
  scale[&Metrics::impact_velocity] = gap * omega;
  scale[&Metrics::major_bounce_height] = gap;
  Judgement found;
  std::vector<Judged>& list = found.figures;
  for (const Figure& figure : compared_figures) list.push_back({figure.value(m), scale[figure]});
  for (std::size_t k = 0; k < p.scene.device.electrodes.size(); ++k) {
    const auto known = p.pull_in.find(p.scene.device.electrodes[k].name);
    const StaticPullIn statically =
        known == p.pull_in.end() ? static_pull_in(p.model, k, bias_of(p.scene, k)) : known->second.statically;
    list.push_back({statically.voltage, 0});
    found.static_pull_in.push_back(statically.voltage);
    if (known != p.pull_in.end()) list.push_back({known->second.dynamically.voltage, 0});
  }
  return found;
}

// The largest relative change of any figure; one that comes or goes has changed entirely.
double change(const std::vector<Judged>& from, const std::vector<Judged>& to) {
  double most = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double relative = relative_difference(to[i].value, from[i].value, least_share * from[i].scale);
    most = std::max(most, std::isfinite(relative) ? relative : 1);
  }
  return most;
}

// Of every electrode.
std::vector<double> resolved_voltages(const Scene& scene) {
  std::vector<double> voltages;
  for (std::size_t k = 0; k < scene.device.electrodes.size(); ++k) voltages.push_back(resolved_pull_in(scene, k));
  return voltages;
}

// Of voltages over those that are resolved; of none that is not known.
double largest_excess(const std::vector<double>& voltages, const std::vector<double>& resolved) {
  double most = 0;
  for (std::size_t k = 0; k < resolved.size(); ++k) most = std::fmax(most, voltages[k] / resolved[k] - 1);
  return most;
}

}  // namespace

std::string AutoModes::note() const {
  const std::string judged =
      touches ? "t_i, v_i, the highest rebound of the first period after contact and the pull-in voltages"
              : "the pull-in voltages, the only figures that are judged since the closing does not touch in its window,";
  const std::string not_judged = "later rebounds, and with them B_H, N_B and t_p, are not judged and may move more";
  return settled() ? fmt::format(R"(structure.modes = "auto": {} mode{}; further ones move {} by at most {}; {})", modes,
                                 modes == 1 ? "" : "s", judged, engineering(100 * moved, "%", 2), not_judged)
                   : fmt::format(R"(structure.modes = "auto": {} mode{}, but further ones still move one of {} by {}; {})", modes,
                                 modes == 1 ? "" : "s", judged, engineering(100 * moved, "%", 2), not_judged);
}

AutoModes choose_modes(const SceneFile& file, const Watch& watch) {
  const Scene scene = read_scene(file);
  const bool both_clamped = scene.device.structure.kind == StructureKind::clamped_clamped;
  const int further = both_clamped ? 6 : 3;
  const std::vector<double> resolved = resolved_voltages(scene);
  std::vector<Judgement> known;
  AutoModes found;
  for (int modes = 1; modes + further <= most_modes; ++modes) {
    found = {.modes = modes};
    for (int more = 1; more <= further && found.settled(); ++more) {
      while (static_cast<int>(known.size()) < modes + more)
        known.push_back(judged(file, static_cast<int>(known.size()) + 1, watch));
      const auto index = static_cast<std::size_t>(modes - 1), further_index = index + static_cast<std::size_t>(more);
      found.moved = std::max({found.moved, change(known[index].figures, known[further_index].figures),
                              largest_excess(known[index].static_pull_in, resolved)});
    }
    found.touches = std::isfinite(known[static_cast<std::size_t>(modes - 1)].figures.front().value);
    if (found.settled()) break;
  }
  return found;
}

}  // namespace softland
