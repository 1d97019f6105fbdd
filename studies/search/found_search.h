// What a search came to, whatever its kind.
#pragma once

#include <variant>

#include "studies/search/search_request.h"

namespace softland {

struct FoundSearch {
  std::variant<OptimizeResult, RobustResult, ForDevicesResult> result;

  /// The waveform found, on the nominal device.
  [[nodiscard]] const OptimizeResult& best() const;
  [[nodiscard]] OptimizeResult& best();
  [[nodiscard]] bool interrupted() const { return best().search.termination == Termination::interrupted; }
  /// Better than the plain step, on the nominal device or, where devices were judged, on these.
  [[nodiscard]] bool is_success() const;
};

/// Runs the search, with the first of its seeds. Of one over devices whose scene has no [spread] one is assumed: assume_spread().
/// Throws InvalidInput as optimize() does.
[[nodiscard]] FoundSearch run(PlannedSearch& search);

}  // namespace softland
