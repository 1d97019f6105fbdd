// Verb `optimize`: the search for a waveform, of the nominal device or of devices that differ.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_request.h"
#include "verbs/study.h"

namespace softland::verbs {

/// Evaluations of a search that the least time of any waveform, a second or two, does not make much longer.
inline constexpr long evaluations_worth_a_limit = 1000;

/// Options that are not told are empty.
struct OptimizeRequest : SearchRequest {
  std::vector<std::string> starts;  ///< results and scenes to begin with
  int jobs = one_per_core();
  std::string cycle = {};  ///< rate at which the pair of waveforms is searched, "2 kHz"; see the verb cycle
  std::string duty = {};   ///< of that
  bool resume = false;
  bool limit = false;  ///< compare the winner with the least time of any waveform, however long that takes
};
/// Throws InvalidRequest for what search_request.h does not look at.
[[nodiscard]] OptimizeRequest optimize_request(const Told& told);

}  // namespace softland::verbs
