// The store of an exploration as its reports want it.
#pragma once

#include <string>

#include "reports/exploration_report.h"
#include "store/study_store.h"

namespace softland {

/// Reads all rows of the store, with the waveforms that it holds. `pareto` names the figures of the front, as --pareto does;
/// empty: those that the plan itself minimises, if it does. Throws InvalidInput as explored_aims() and StudyReader do.
[[nodiscard]] ExplorationReport read_exploration(const StudyReader& store, const std::string& pareto);

/// Adds the waveforms of the points on the front that the store does not hold, from their scenes. A point whose scene cannot be
/// prepared stays without.
void add_front_waveforms(ExplorationReport& report, const StudyReader& store, const Progress& progress);

}  // namespace softland
