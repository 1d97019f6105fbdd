// Reads the database file of an exploration for its reports.
#pragma once

#include <string>

#include "reports/exploration_report.h"
#include "store/study_store.h"

namespace softland {

/// Reads all rows of the database file, with the stored waveforms. `pareto` names the figures of merit of the Pareto front, as
/// the option --pareto does; empty: the figures that the plan minimises, if any. Throws InvalidInput as explored_aims() and
/// StudyReader do.
[[nodiscard]] ExplorationReport read_exploration(const StudyReader& store, const std::string& pareto);

/// Adds waveforms that the database file lacks to the points on the Pareto front, by preparing their scenes. A point whose
/// scene cannot be prepared gets no waveform.
void add_front_waveforms(ExplorationReport& report, const StudyReader& store, const Progress& progress);

}  // namespace softland
