// Verb `optimize`: searches a waveform for the nominal design, or for devices under process variation.
#pragma once

#include <string>
#include <vector>

#include "studies/search/search_request.h"
#include "verbs/study.h"

namespace softland::verbs {

/// A search with at least this number of evaluations also computes the least closing time of any waveform (verb `limit`), which
/// takes a second or two.
inline constexpr long evaluations_worth_a_limit = 1000;

/// The options of the verb `optimize`; an option that is not given is empty.
struct OptimizeRequest : SearchRequest {
  std::vector<std::string> starts;  ///< results and scenes with waveforms at which the search begins
  int jobs = one_per_core();
  std::string cycle = {};  ///< cycle rate for which closing and opening waveforms are searched, "2 kHz"; see the verb `cycle`
  std::string duty = {};   ///< share of the cycle in which the switch is commanded closed
  bool resume = false;
  /// True: compare the best waveform with the least closing time of any waveform, even if that computation takes minutes.
  bool limit = false;
};
/// Reads the options of `optimize` from the arguments. Throws InvalidRequest for invalid options; options of SearchRequest are
/// checked later (search_request.h).
[[nodiscard]] OptimizeRequest optimize_request(const Arguments& arguments);

}  // namespace softland::verbs
