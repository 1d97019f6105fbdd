#include "studies/search/modes_of_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/require.h"
#include "model/constants.h"
#include "studies/closing/checking_runs.h"

namespace softland {
namespace {

// Limits the slew of searched drives without max_slew: from one end of its range to the other, a drive then takes at least one
// period of the highest mode. Returns true if a limit changes.
bool make_gentle(SearchSetting& setting) {
  const double shortest_period = 2 * pi / setting.given.model.basis().angular_frequencies().maxCoeff();
  bool changes = false;
  for (const DriveSearch& s : setting.space.drives()) {
    DriverLimits& limits = setting.limits.at(s.drive);
    if (std::isfinite(limits.max_slew)) continue;
    limits.max_slew = (limits.max_voltage - limits.min_voltage) / shortest_period;
    changes = true;
  }
  return changes;
}

}  // namespace

std::vector<SearchSetting> with_gentle_edges(const std::vector<SearchSetting>& settings, Actuator actuator,
                                             const std::string& families, const OwnWaveforms& own) {
  const SearchSetting& first = settings.front();
  if (with_more_modes(first.given.scene.device).empty()) return {};
  const std::vector<std::string> names = families_of(families);
  std::vector<SearchSetting> gentle = settings;
  for (std::size_t k = 0; k < settings.size(); ++k) {
    SearchSetting changed = settings[k];
    if (!make_gentle(changed)) return {};
    try {
      changed.space = SearchSpace(changed.within_limits(), actuator, names[k], first.scale.step.initial_contact_time, own);
    } catch (const InvalidInput&) {
      continue;
    }
    gentle[k] = std::move(changed);
  }
  return gentle;
}

bool begins_gently(const std::vector<SearchSetting>& gentle, const std::vector<StartingWaveforms>& starts) {
  if (gentle.empty()) return false;
  const SearchSetting& setting = gentle.front();
  const auto fits = [&](const DriveWaveforms& waveforms) { return setting.is_allowed(setting.space.searched(waveforms)); };
  return std::ranges::any_of(setting.space.drives(), [](const DriveSearch& s) { return s.drive == piezo_drive; }) &&
         (setting.starts_as_step() || fits(setting.given.drives.waveforms())) &&
         std::ranges::all_of(starts, [&](const StartingWaveforms& start) { return fits(start.waveforms); });
}

SearchSetting by_the_worst_of_modes(SearchSetting setting) {
  const std::vector<double> holds = hold_levels(setting.baseline_scene.signals());
  for (const Device& device : with_more_modes(setting.given.scene.device)) {
    RicherBeam beam{.model = Switch(device, quadrature_of_richer(setting.given.quadrature, device))};
    if (const auto closed = closed_equilibrium(beam.model, holds)) beam.closed_potential = closed->potential;
    setting.richer.push_back(std::move(beam));
  }
  return setting;
}

}  // namespace softland
