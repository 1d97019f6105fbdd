// Connects an exploration with the database file that stores its points.
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "config/plan.h"
#include "store/study_store.h"
#include "studies/exploration/exploration.h"

namespace softland {

/// Returns the description of one part (shard) of the exploration, which the database file of this part stores.
[[nodiscard]] StoredPlan stored_plan(const Exploration& exploration, const Shard& shard);
/// Returns the exploration that `plan` (its stored request) describes, for the database file `store`. If the file already
/// stores this exploration, the columns are those in the file.
[[nodiscard]] Exploration exploration_for(Plan plan, const std::filesystem::path& store, const Progress& progress = {},
                                          const OtherStudies& others = {});
/// Throws InvalidRequest about the field `shard` if the exploration cannot be divided into parts, such as one that searches a
/// Pareto front.
void require_part(const Exploration& exploration, const Shard& shard);
/// Returns the plan (stored request) of the exploration in a database file. Throws InvalidInput if the file contains a search
/// instead.
[[nodiscard]] PlanRequest exploration_in(const StudyReader& store);
/// Returns the row to store for a point of an exploration with these values of the variables [SI unit].
[[nodiscard]] StoredRow stored_row(std::int64_t point, const ContentKey& content, std::vector<double> values, PointRow row);

/// The rows of a database file, by the values of their variables.
using KnownRows = std::map<std::vector<double>, StoredRow>;
[[nodiscard]] KnownRows known_rows(const std::filesystem::path& store);

}  // namespace softland
