// Findings that reports need of a search over devices, besides its final evaluation: the Pareto front of its candidate
// waveforms, contact gaps over time, and all rows of results.
#pragma once

#include <cstdint>

#include "base/progress.h"
#include "studies/search/robust_search_study.h"

namespace softland {

/// Finds the Pareto front of the candidate waveforms in time of first contact and impact velocity, and evaluates its candidates
/// on the fresh devices (new to the search).
void judge_front(RobustSearchResult& result, RobustSearch& search, const Progress& progress);
/// Computes the contact gaps of some devices over time, under the plain step and the best waveform, until the contact force is
/// steady.
void draw_courses(RobustSearchResult& result, const RobustnessOptions& judging, const Progress& progress);
/// Copies the results of the search to the findings, except those that were added during the final evaluation.
void complete_findings(RobustSearchResult& result, RobustSearch& search, std::uint64_t seed);

}  // namespace softland
