#include "studies/search/found_search.h"

#include "config/assumed_spread.h"

namespace softland {
namespace {

template <class Found>
auto& best_of(Found& found) {
  if constexpr (requires { found.found; }) {
    return found.found;
  } else if constexpr (requires { found.nominal; }) {
    return found.best;
  } else {
    return found;
  }
}

RobustSearchResult searched_for_devices(const PlannedSearch& search) {
  RobustSearchResult found = robust_search(search.scene, search.options, *search.for_devices);
  if (found.interrupted) found.best.search.termination = Termination::interrupted;
  return found;
}

}  // namespace

const OptimizeResult& FoundSearch::best() const {
  return std::visit([](const auto& found) -> const OptimizeResult& { return best_of(found); }, result);
}

OptimizeResult& FoundSearch::best() {
  return std::visit([](auto& found) -> OptimizeResult& { return best_of(found); }, result);
}

bool FoundSearch::is_success() const {
  const auto* devices = std::get_if<RobustSearchResult>(&result);
  // If the plain step is the result, it counts as a success only if it closes without a bounce.
  const bool has_answer = devices == nullptr || !devices->best.plain_step_wins || devices->plain_step_is_bounce_free();
  return best().is_success() && has_answer;
}

FoundSearch run(PlannedSearch& search) {
  if (search.for_devices) return {searched_for_devices(search)};
  if (!search.robust) return {optimize(search.scene, search.options)};
  assume_spread(search.scene);
  return {robust_optimize(search.scene, search.options, *search.robust)};
}

}  // namespace softland
