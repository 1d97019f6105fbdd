#include "studies/closing/auto_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "base/engineering.h"
#include "model/closing.h"
#include "model/constants.h"
#include "objectives/figure_values.h"
#include "studies/closing/by_modes.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/closing_progress.h"
#include "studies/closing/prepared.h"
#include "studies/closing/quadrature.h"

namespace softland {
namespace {

constexpr double run_tolerance = 1e-6;  // relative tolerance of the integrator, whose errors are far below auto_modes_tolerance
// A change is relative to the figure, but at least to this share of the figure's scale: a figure near 0 would change too much.
constexpr double least_share = 0.01;

struct Judged {
  double value, scale;
};

// The figures of a closing that are compared between numbers of modes.
struct Judgement {
  std::vector<Judged> figures;
  PreparedScene scene;
};

// Finds pull-in voltages only as precisely as the comparison of modes needs: computing a dynamic pull-in voltage takes as long
// as tens of closings.
ElectrodePullIn pull_in_to_be_judged(const Switch& model, std::size_t electrode, Bias bias, const Progress& progress) {
  constexpr double precision = 1e-5;
  ElectrodePullIn found{.statically = static_pull_in(model, electrode, bias)};
  found.dynamically = dynamic_pull_in(model, electrode, found.statically, bias, progress, run_tolerance, precision);
  return found;
}

Judgement judged(const SceneFile& file, int modes, const Progress& progress) {
  SceneFile with = file;
  with.assign("structure.modes", modes);
  // Numbers of modes are compared with all physical effects of the scene; effects are left out later.
  with.assign("simulate.effects", std::string("all"));
  const PreparedScene p = prepare(with, false, progress, pull_in_to_be_judged);
  const double omega = p.model.basis().angular_frequencies()[0], gap = p.scene.device.contact_gap();
  const Trajectory t =
      simulate_closing(p.model, p.signals(),
                       {.duration = p.duration,
                        .tolerance = std::max(run_tolerance, p.tolerance),
                        .after_contact = 2 * pi / omega,
                        .start = p.start(),
                        .stop = progress.stop,
                        .observer = observer(progress, fmt::format("closing with {} modes", modes), p.duration)});
  progress.throw_if_stopped();
  const Metrics m = metrics(t, p.scene.metrics);
  FigureValues scale;
  scale[&Metrics::initial_contact_time] = 1 / omega;
  scale[&Metrics::impact_velocity] = gap * omega;
  scale[&Metrics::major_bounce_height] = gap;
  std::vector<Judged> list;
  for (const Figure& figure : compared_figures) list.push_back({figure.value(m), scale[figure]});
  for (std::size_t k = 0; k < p.scene.device.electrodes.size(); ++k) {
    const auto known = p.pull_in.find(p.scene.device.electrodes[k].name);
    const StaticPullIn statically =
        known == p.pull_in.end() ? static_pull_in(p.model, k, bias_of(p.scene, k)) : known->second.statically;
    list.push_back({statically.voltage, 0});
    if (known != p.pull_in.end()) list.push_back({known->second.dynamically.voltage, 0});
  }
  return {.figures = std::move(list), .scene = p};
}

// Returns the largest relative change of any figure between two closings; a figure that exists in only one of them changes by 1
// (100 %).
double change(const std::vector<Judged>& from, const std::vector<Judged>& to) {
  double most = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double relative = relative_difference(to[i].value, from[i].value, least_share * from[i].scale);
    most = std::max(most, std::isfinite(relative) ? relative : 1);
  }
  return most;
}

// Returns the largest relative change of the electrodes' static voltages (pull-in, release, collapse) with twice and four times
// as many modes.
double statics_moved(const Scene& scene, int modes) {
  const Switch own = resolved_switch(scene.device, scene.simulate.accuracy, modes).model;
  const ModeLadder ladder(scene, own);
  double most = 0;
  for (std::size_t k = 0; k < scene.device.electrodes.size(); ++k) {
    if (!pulls_in(scene.device, k)) continue;
    const VoltagesByModes more = voltages_by_modes(ladder, scene, k, closed_range(own, k, bias_of(scene, k)).pulled_through);
    for (const ByModes* voltage : {&more.static_pull_in, &more.release, &more.pulled_through})
      most = std::fmax(most, std::min(1.0, std::abs(voltage->moved())));
  }
  return most;
}

// True if the closed state under the hold levels is as stable with more modes as with the scene's number, or does not exist.
bool agrees_on_stability(const PreparedScene& p) {
  const ModeLadder ladder(p);
  const auto closed = closed_equilibria(ladder, hold_levels(p.signals()));
  return !closed.front() || (judges_stability(p.model) && !stability(ladder, closed).flips);
}

}  // namespace

std::string AutoModes::note() const {
  const std::string judged =
      touches
          ? "t_i, v_i, the highest rebound of the first period after contact and the pull-in, release and pull-through voltages"
          : "the static voltages, the only figures that are judged since the closing does not touch in its window,";
  const std::string not_judged = "later rebounds, and with them B_H, N_B and t_p, are not judged and may move more";
  return settled() ? fmt::format(R"(structure.modes = "auto": {} mode{}; further ones move {} by at most {}; {})", modes,
                                 modes == 1 ? "" : "s", judged, engineering(100 * moved, "%", 2), not_judged)
                   : fmt::format(R"(structure.modes = "auto": {} mode{}, but further ones still move one of {} by {}; {})", modes,
                                 modes == 1 ? "" : "s", judged, engineering(100 * moved, "%", 2), not_judged);
}

AutoModes choose_modes(const SceneFile& file, const Progress& progress) {
  const Scene scene = read_scene(file);
  const bool both_clamped = scene.device.structure.has_far_clamp();
  const int further = both_clamped ? 6 : 3;
  std::map<int, Judgement> known;
  const auto with = [&](int modes) -> const Judgement& {
    const auto found = known.find(modes);
    return found != known.end() ? found->second : known.emplace(modes, judged(file, modes, progress)).first->second;
  };
  AutoModes found;
  for (int modes = 1; modes + further <= most_modes; ++modes) {
    // Static voltages take little time to compute: skip the closings with a number of modes for which the static voltages still
    // change. The last number is returned in any case, and its closing shows whether the switch touches.
    found = {.modes = modes, .moved = statics_moved(scene, modes)};
    if (!found.settled() && modes + further < most_modes) continue;
    const Judgement& own = with(modes);
    found.touches = std::isfinite(own.figures.front().value);
    for (int more = 1; more <= further && found.settled(); ++more)
      found.moved = std::max(found.moved, change(own.figures, with(modes + more).figures));
    if (found.settled() && !agrees_on_stability(own.scene)) found.moved = 1;
    if (found.settled()) break;
  }
  return found;
}

}  // namespace softland
