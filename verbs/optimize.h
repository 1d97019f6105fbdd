// Verb `optimize`: searches a waveform for the nominal device or under process variation.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_request.h"
#include "verbs/study.h"

namespace softland::verbs {

/// Number of evaluations from which a search also computes the least time of any waveform (verb `limit`), which takes a second or
/// two.
inline constexpr long evaluations_worth_a_limit = 1000;

/// The options of `optimize`; those that are not given are empty.
struct OptimizeRequest : SearchRequest {
  std::vector<std::string> starts;  ///< results and scenes to begin with
  int jobs = one_per_core();
  std::string cycle = {};  ///< rate for which closing and opening waveforms are searched, "2 kHz"; see the verb `cycle`
  std::string duty = {};   ///< duty of the cycle
  bool resume = false;
  bool limit = false;  ///< true: compare the winner with the least time of any waveform, however long that takes
};
/// Reads the request. Throws InvalidRequest for invalid options; those of SearchRequest are checked later (search_request.h).
[[nodiscard]] OptimizeRequest optimize_request(const Arguments& arguments);

}  // namespace softland::verbs
