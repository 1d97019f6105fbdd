#include "studies/closing/open_state.h"

#include <algorithm>
#include <cmath>

#include "model/constants.h"
#include "model/pull_in.h"
#include "objectives/opening.h"

namespace softland {

void set_open_figures(Metrics& metrics, const Trajectory& run, const Switch& model, const std::vector<Signal>& signals) {
  if (run.status != Status::done || run.points.empty()) return;
  const bool is_open = run.touches.empty() || (run.began_closed && std::isfinite(run.touches.back().end));
  if (!is_open) return;
  const std::optional<Eigen::VectorXd> rest = model.open_equilibrium(hold_levels(signals));
  if (!rest) return;
  const double position = model.contact_deflection(rest->data()), start = run.points.front().position;
  const BandFigures all = band_figures(run, {.open_position = position});
  const double band = settled_share * std::max(all.below, all.above);
  const double settled_from = band > 0 ? band_figures(run, {.open_position = position, .width = band}).settled_from : 0;
  metrics.static_deflection = position;
  metrics.overshoot = start > position ? all.below : all.above;
  const double period = 2 * pi / model.basis().angular_frequencies()[0];
  if (run.points.back().time - settled_from >= period) metrics.open_settling_time = settled_from;
  if (!run.began_closed || !std::isfinite(metrics.open_settling_time)) return;
  metrics.status = Status::done;
  metrics.settled = true;
}

bool stays_open(const Switch& model, const std::vector<Signal>& signals, double duration, const Progress& progress) {
  const std::vector<double> levels = hold_levels(signals);
  if (!model.open_equilibrium(levels)) return false;
  for (std::size_t k = 0; k < signals.size(); ++k) {
    const Signal::Range range = signals[k].range(duration);
    for (const double extreme : {range.minimum, range.maximum}) {
      std::vector<double> values = levels;
      values[k] = extreme;
      if (extreme != levels[k] && !model.open_equilibrium(values)) return false;
    }
    if (model.drive_kind(k) == DriveKind::piezo || !pulls_in(model.device(), k)) continue;
    // An electrode attracts the beam at either sign of its voltage: take the extreme that pulls more.
    const double pull = std::max(model.strength(k, range.minimum), model.strength(k, range.maximum));
    const double most = model.drive_kind(k) == DriveKind::electrode ? model.value_of_strength(k, pull) : range.maximum;
    if (step_closes(model, k, most, levels, progress)) return false;
  }
  return true;
}

}  // namespace softland
