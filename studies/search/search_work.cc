#include "studies/search/search_work.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "model/closing.h"
#include "studies/devices/ensemble.h"

namespace softland {
namespace {

class NoObserver final : public ClosingObserver {};

// A waveform of a user's own may throw, which the search itself takes for a bad candidate.
DriveWaveforms first_waveforms(const SearchSetting& setting) {
  const bool has_own = std::ranges::any_of(setting.space.drives(), [](const DriveSearch& drive) { return bool(drive.own); });
  return has_own ? DriveWaveforms() : setting.space.waveforms(setting.space.starts().front());
}

}  // namespace

ClosingWork closing_work(const SearchSetting& setting) {
  constexpr double points_beside = 8, usual_points = 32;  // what a right-hand side takes besides its points, as a number of them
  const Switch& model = setting.given.model;
  const double points = points_beside + static_cast<double>(model.quadrature().points());
  ClosingWork most;
  for (const DriveWaveforms& searched : {DriveWaveforms(), first_waveforms(setting)}) {
    const std::vector<Signal> signals = setting.given.driven(setting.drives(searched));
    NoObserver nobody;
    const Work work = observe_closing(model, signals, setting.run_of(signals), nobody).work;
    const double counted =
        static_cast<double>(work.rhs_evaluations) * points / usual_points * (1 + static_cast<double>(model.film_states()));
    if (counted > most.counted) most = {.counted = counted, .seconds = work.wall};
  }
  return most;
}

double device_seconds(const SearchSetting& setting) {
  const SampledDevice nominal{.values = {}, .model = setting.given.model, .refusal = {}};
  const std::vector<Signal> signals = setting.given.driven(setting.drives(first_waveforms(setting)));
  const bool in_lanes = why_not_in_lanes(setting.given.model).empty() && vectors_in_use() != Vectors::none;
  ClosingOptions run = setting.run_of(signals);
  run.tolerance = EnsembleRun{}.tolerance;
  const std::size_t count = in_lanes ? 32 : 1;
  const std::vector<DeviceClosing> closings(count, {.device = &nominal, .signals = &signals, .run = run});
  const auto begin = std::chrono::steady_clock::now();
  (void)close_devices(closings, setting.given.scene.metrics, vectors_in_use());
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  return elapsed.count() / static_cast<double>(count);
}

double usual_work(Shaped drives) { return drives == Shaped::piezo ? 8000 : 4000; }

long within_work(long closings, double counted, double usual) {
  if (!(counted > usual)) return closings;
  return std::max(1L, std::lround(static_cast<double>(closings) * usual / counted));
}

}  // namespace softland
