// The result of a search of any kind.
#pragma once

#include <variant>

#include "studies/search/search_request.h"

namespace softland {

struct FoundSearch {
  std::variant<OptimizeResult, RobustResult, RobustSearchResult> result;

  /// The waveform found, on the nominal device.
  [[nodiscard]] const OptimizeResult& best() const;
  [[nodiscard]] OptimizeResult& best();
  [[nodiscard]] bool interrupted() const { return best().search.termination == Termination::interrupted; }
  /// True if better than the plain step, on the devices where these were judged, else on the nominal device.
  [[nodiscard]] bool is_success() const;
};

/// Runs the search with the first of its seeds. A search over devices assumes a spread if the scene has no [spread]:
/// assume_spread(). Throws InvalidInput as optimize() does.
[[nodiscard]] FoundSearch run(PlannedSearch& search);

}  // namespace softland
