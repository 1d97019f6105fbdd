// What `softland explore` is asked for: its options, and the plan that they make.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/options.h"
#include "config/plan.h"
#include "store/study_store.h"
#include "studies/exploration/stored_exploration.h"

namespace softland::apps {

/// The words of the options; what was not given is empty.
struct ExploreRequest {
  std::vector<std::string> vary, options;
  std::string sample, pareto, list, study, target, actuator, waveform, optimizer, shard;
  std::string out;
  std::optional<std::string> samples, budget, seed, jobs, point;
  bool certify = false, resume = false;

  /// What belongs to a plan, by the name of its option.
  [[nodiscard]] std::map<std::string, std::string> of_plan() const;
};

/// The plan of a scene and options, of a plan file, or of a store that is gone on with.
[[nodiscard]] PlanRequest plan_request(const Common& common, const ExploreRequest& request);

/// What --shard says, else what the store that is gone on with holds; `store` may be empty.
[[nodiscard]] Shard shard_of(const ExploreRequest& request, const std::string& store);

}  // namespace softland::apps
