// A search as its stores keep it: the plan of all that decides what it finds, from which it can be gone on with.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/options.h"
#include "config/scene.h"
#include "studies/search_request.h"

namespace softland::apps {

/// What the command line says; what was not given is empty.
struct OptimizeRequest : SearchRequest {
  std::vector<std::string> starts;  ///< results and scenes to begin with
  std::optional<std::string> jobs;  ///< default: one per core
  bool resume = false;
  bool limit = false;  ///< compare the winner with the least time of any waveform, however long that takes
};

/// Of a search that the least time of any waveform, a second or two, does not make much longer.
inline constexpr long evaluations_worth_a_limit = 1000;

struct KeptSearch : PlannedSearch {
  nlohmann::json plan;
};

/// Reads the command line. `known` is the plan of the search that is gone on with, which has the word where an option is not
/// given; a null value where there is none. Throws InvalidInput with option, value and rule.
[[nodiscard]] KeptSearch kept_search(const Common& c, const OptimizeRequest& given, const nlohmann::json& known);

/// Why a search that is asked for does not go on with one of the plan `there`, in words; empty where it does: they differ in
/// nothing but the budget, or the asked one has more seeds.
[[nodiscard]] std::string difference(const nlohmann::json& there, const nlohmann::json& asked);

/// Of a plan for one of its seeds alone, which is what decides the bits of that search.
[[nodiscard]] nlohmann::json plan_of_seed(const nlohmann::json& plan, std::uint64_t seed);

}  // namespace softland::apps
