// An exploration in its store.
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "config/plan.h"
#include "store/study_store.h"
#include "studies/exploration/exploration.h"

namespace softland {

/// Returns the part of the plan that its store holds.
[[nodiscard]] StoredPlan stored_plan(const Exploration& exploration, const Shard& shard);
/// Returns the exploration of `plan` for the store. If the store holds it already, the columns are those in the store.
[[nodiscard]] Exploration exploration_for(Plan plan, const std::filesystem::path& store, const Progress& progress = {},
                                          const OtherStudies& others = {});
/// Throws InvalidRequest about the field `shard` if the exploration has no such part: a search of a front cannot be divided.
void require_part(const Exploration& exploration, const Shard& shard);
/// Returns the plan of the exploration that a store holds. Throws InvalidInput if the store holds a search.
[[nodiscard]] PlanRequest exploration_in(const StudyReader& store);
/// Returns the row to store for a point with these values of the variables [SI unit].
[[nodiscard]] StoredRow stored_row(std::int64_t point, const ContentKey& content, std::vector<double> values, PointRow row);

/// The rows of a store, by the values of their variables.
using KnownRows = std::map<std::vector<double>, StoredRow>;
[[nodiscard]] KnownRows known_rows(const std::filesystem::path& store);

}  // namespace softland
