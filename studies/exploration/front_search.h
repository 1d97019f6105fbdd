// A search for the front of an exploration, whose points go into a store as they are found.
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

/// Of a plan for a front that says nothing else.
inline constexpr std::string_view usual_front_sample = "nsga2:2000";

/// Of the plan of an exploration that is a search. Throws as explored_aims().
[[nodiscard]] std::vector<ExploredAim> aims_of(const Exploration& exploration);

/// How far it is.
struct FrontFound {
  std::int64_t points = 0;    ///< of the plan
  std::int64_t asked = 0;     ///< by the search, of these
  std::int64_t known = 0;     ///< in the store when it began
  std::int64_t computed = 0;  ///< that were not
  Termination termination = Termination::interrupted;
};

struct FrontOptions {
  int jobs = 1;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const FrontFound&)> on_point = nullptr;  ///< called under a lock after every point
};

/// The plan of the exploration is a search. Point k is the k-th that the search asks for; one that is in `known`, or under an
/// earlier plan in the store, is not computed again, so that a search that was interrupted ends with the rows of one that was
/// not. Throws as StudyStore::add().
[[nodiscard]] FrontFound search_front(Exploration& exploration, StudyStore& store, KnownRows known,
                                      const std::vector<ExploredAim>& aims, const FrontOptions& options);

}  // namespace softland
