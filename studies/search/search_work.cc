#include "studies/search/search_work.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/closing.h"

namespace softland {
namespace {

class NoObserver final : public ClosingObserver {};

// Returns the waveforms at the first starting point; none for waveforms from the user's code, which may throw exceptions.
DriveWaveforms first_waveforms(const SearchSetting& setting) {
  const bool has_own = std::ranges::any_of(setting.space.drives(), [](const DriveSearch& drive) { return bool(drive.own); });
  return has_own ? DriveWaveforms() : setting.space.waveforms(setting.space.starts().front());
}

}  // namespace

ClosingWork closing_work(const SearchSetting& setting) {
  // Work of a right-hand side besides its quadrature points (points_beside), and the work that counts as 1 (usual_points), in
  // units of one quadrature point.
  constexpr double points_beside = 8, usual_points = 32;
  const Switch& model = setting.given.model;
  const double points = points_beside + static_cast<double>(model.quadrature().points());
  ClosingWork most;
  for (const DriveWaveforms& searched : {DriveWaveforms(), first_waveforms(setting)}) {
    const std::vector<Signal> signals = setting.given.applied(setting.drives(searched));
    NoObserver nobody;
    const Work work = observe_closing(model, signals, setting.run_of(signals), nobody).work;
    const double counted =
        static_cast<double>(work.rhs_evaluations) * points / usual_points * (1 + static_cast<double>(model.film_states()));
    if (counted > most.counted) most = {.counted = counted, .seconds = work.wall};
  }
  return most;
}

double usual_work(Shaped drives) { return drives == Shaped::piezo ? 8000 : 4000; }

long within_work(long closings, double counted, double usual) {
  if (!(counted > usual)) return closings;
  return std::max(1L, std::lround(static_cast<double>(closings) * usual / counted));
}

void fit_nominal_budget(const SearchSetting& setting, OptimizeOptions& options) {
  if (!options.counts_work && !options.on_estimate) return;
  constexpr double by_evaluation = 1.5;  // closings per evaluation: gradients and verification take another half
  const ClosingWork one = closing_work(setting);
  const long asked = options.max_evaluations;
  if (options.counts_work) {
    const double usual = usual_work(shaped_drives(setting.given.scene.file, options.actuator));
    options.max_evaluations = within_work(asked, one.counted, usual);
    options.more_evaluations = options.more_evaluations > 0 ? within_work(options.more_evaluations, one.counted, usual) : 0;
  }
  if (!options.on_estimate) return;
  const double seconds = by_evaluation * static_cast<double>(options.max_evaluations) * one.seconds;
  options.on_estimate({.closing = one.seconds,
                       .evaluations = options.max_evaluations,
                       .has_fewer = options.max_evaluations < asked,
                       .seconds = std::min(seconds, options.max_seconds * options.jobs)});
}

}  // namespace softland
