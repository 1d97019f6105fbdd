// Verb `explore`: computes many points of a design space and stores the results in a database file.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/plan.h"
#include "store/study_store.h"
#include "verbs/study.h"

namespace softland::verbs {

/// The options of the verb `explore`; an option that is not given is empty.
struct ExploreRequest {
  std::vector<std::string> vary, options;
  std::string sample, pareto, list, study, target, actuator, waveform, optimizer, shard, out;
  std::optional<std::string> samples, budget;
  std::optional<std::uint64_t> seed, point;
  int jobs = one_per_core();
  bool certify = false, resume = false;

  /// Returns the given options that are part of an exploration's plan (its stored request), by name.
  [[nodiscard]] std::map<std::string, std::string> of_plan() const;
  /// Returns the plan of an exploration (its stored request) from these options and a scene. Messages spell option names by
  /// `spelling`. Throws InvalidInput.
  [[nodiscard]] PlanRequest plan(SceneFile scene, const Spelling& spelling) const;
  /// Returns the part of the exploration's points that --shard selects. Throws InvalidRequest.
  [[nodiscard]] Shard part() const;
};
/// Reads the options of `explore` from the arguments. Throws InvalidRequest.
[[nodiscard]] ExploreRequest explore_request(const Arguments& arguments);

}  // namespace softland::verbs
