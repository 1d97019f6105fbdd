// Verb `optimize`: searches a waveform for the nominal device or under process variation.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_request.h"
#include "verbs/study.h"

namespace softland::verbs {

/// The least time of any waveform takes a second or two: a search of this many evaluations is hardly longer with it.
inline constexpr long evaluations_worth_a_limit = 1000;

/// Options that are not given are empty.
struct OptimizeRequest : SearchRequest {
  std::vector<std::string> starts;  ///< results and scenes to begin with
  int jobs = one_per_core();
  std::string cycle = {};  ///< rate for which the pair of waveforms is searched, "2 kHz"; see the verb cycle
  std::string duty = {};   ///< duty of the cycle
  bool resume = false;
  bool limit = false;  ///< true: compare the winner with the least time of any waveform, however long that takes
};
/// Reads the request. Throws InvalidRequest for options that search_request.h does not check.
[[nodiscard]] OptimizeRequest optimize_request(const Told& told);

}  // namespace softland::verbs
