// A search over varied devices for a quasi-static approach. CMA-ES begins at a closed-form waveform, and uses more devices in
// every round (stage). The pace is given by the time from which on the devices have to carry a steady contact force.
#pragma once

#include <functional>
#include <optional>

#include "studies/search/family_tournament.h"

namespace softland {

/// The pace of a quasi-static approach, which is the time that the slow closing may take, and the number of its waveform
/// family.
struct Pace {
  double of_step = 1;      ///< permitted time until a steady contact force, as a multiple of that time under the plain step
  std::size_t family = 0;  ///< index of the waveform family among the settings of the search
};

/// Searches the waveforms of a quasi-static approach at a pace. The waveform family of `setting` must be quasi-static. The aim
/// of the whole search, `aim`, holds in its FreeTime the time until a steady force under the plain step. Returns nothing if no
/// waveform of this pace is within the limits, or if the budget ends before a waveform was tried. TournamentOptions::closings
/// scales the number of closings of this search, as in family_tournament().
[[nodiscard]] std::optional<Contender> search_at_pace(const SearchSetting& setting, const Pace& pace, const RobustCost& cost,
                                                      const RobustAim& aim, SearchBudget& budget,
                                                      const TournamentOptions& options);

}  // namespace softland
