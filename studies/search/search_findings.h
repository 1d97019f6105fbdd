// What reports need of a search over devices, besides its verdict: the front of its candidates, gaps over time, and all rows.
#pragma once

#include <cstdint>

#include "base/progress.h"
#include "studies/search/robust_search_study.h"

namespace softland {

/// Finds the Pareto front of the candidates in time and impact velocity, and judges its candidates on the fresh devices.
void judge_front(RobustSearchResult& result, RobustSearch& search, const Progress& progress);
/// Computes contact gaps of devices over time, under the plain step and the winner, until the contact force is steady.
void draw_courses(RobustSearchResult& result, const RobustnessOptions& judging, const Progress& progress);
/// Adds the findings that were not stored earlier.
void complete_findings(RobustSearchResult& result, RobustSearch& search, std::uint64_t seed);

}  // namespace softland
