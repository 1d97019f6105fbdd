// Searches the Pareto front of an exploration, and stores the points as soon as they are computed.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "optimizers/problem.h"
#include "studies/exploration/aims.h"
#include "studies/exploration/stored_exploration.h"

namespace softland {

/// Default value of the option `sample` for an exploration that searches a Pareto front.
inline constexpr std::string_view usual_front_sample = "nsga2:2000";

/// Returns the figures to minimise or maximise in an exploration that searches a Pareto front. Throws the exceptions of
/// explored_aims().
[[nodiscard]] std::vector<ExploredAim> aims_of(const Exploration& exploration);

/// The progress of a search for a Pareto front.
struct FrontFound {
  std::int64_t points = 0;    ///< number of points that the search may request
  std::int64_t asked = 0;     ///< number of points that the search has requested
  std::int64_t known = 0;     ///< number of points that the database file had at the beginning
  std::int64_t computed = 0;  ///< number of points that this run computed
  Termination termination = Termination::interrupted;
};

struct FrontOptions {
  int jobs = 1;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const FrontFound&)> on_point = nullptr;  ///< function that is called under a lock after every point
};

/// Searches the Pareto front of an exploration whose plan (stored request) requests this search. Point k is the k-th point that
/// the search requests. A point in `known`, or of an earlier plan in `store`, is not computed again: a repeated search after an
/// interruption ends with the same rows. Throws the exceptions of StudyStore::add().
[[nodiscard]] FrontFound search_front(Exploration& exploration, StudyStore& store, KnownRows known,
                                      const std::vector<ExploredAim>& aims, const FrontOptions& options);

}  // namespace softland
