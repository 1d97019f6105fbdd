// The result of a search: on the nominal device, over devices by one measure of risk, or over devices by a tournament of
// waveform families.
#pragma once

#include <variant>

#include "studies/search/search_request.h"

namespace softland {

struct FoundSearch {
  std::variant<OptimizeResult, RobustResult, RobustSearchResult> result;

  /// Returns the found waveform, with the closing of the nominal device.
  [[nodiscard]] const OptimizeResult& best() const;
  [[nodiscard]] OptimizeResult& best();
  [[nodiscard]] bool interrupted() const { return best().search.termination == Termination::interrupted; }
  /// True if the found waveform is better than the plain step: on the varied devices if the search has simulated any, else on
  /// the nominal device.
  [[nodiscard]] bool is_success() const;
};

/// Runs the search with the first of its seeds. A search over varied devices of a scene without [spread] uses the spread of
/// assume_spread(). Throws the exceptions of optimize().
[[nodiscard]] FoundSearch run(PlannedSearch& search);

}  // namespace softland
