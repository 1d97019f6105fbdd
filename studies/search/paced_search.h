// A search for a quasi-static approach over devices. CMA-ES begins at the closed form, on ever more devices. The pace is set by
// the time from which on the devices have to carry a steady force.
#pragma once

#include <functional>
#include <optional>

#include "studies/search/race.h"

namespace softland {

/// A pace, and the family that is searched at it.
struct Pace {
  double of_step = 1;      ///< time in which devices have to carry a steady force, over that of the plain step
  std::size_t family = 0;  ///< its number among the settings
};

/// Searches at a pace. `setting` is that of a quasi-static family; `aim` is the aim of the whole search, whose free time is
/// that of the plain step. None if no such waveform is within the limits, or the budget was over before it had tried one. The
/// closings of `options` scale those of the search, as those of a race.
[[nodiscard]] std::optional<Contender> search_at_pace(const SearchSetting& setting, const Pace& pace, const RobustCost& cost,
                                                      const RobustAim& aim, SearchBudget& budget, const RaceOptions& options);

}  // namespace softland
