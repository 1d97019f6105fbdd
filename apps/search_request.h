// What `softland optimize` is asked for: its options, and the plan that the stores of a search keep of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/options.h"
#include "config/scene.h"
#include "studies/for_devices.h"
#include "studies/optimize.h"
#include "studies/robust_optimize.h"

namespace softland::apps {

/// The words of the options; what was not given is empty.
struct OptimizeRequest {
  std::string target, actuator, waveform, optimizer;
  std::string robust;                   ///< "auto", "none", or the measure of a search over devices; empty: auto, of one seed
  std::vector<std::string> conditions;  ///< of the winner, or of a robust search
  std::string calibration;              ///< what is measured on every device; empty: what the scene says
  std::optional<std::string> samples;   ///< devices of a robust search
  std::vector<std::string> starts;      ///< results and scenes to begin with
  std::optional<std::string> budget;    ///< evaluations ("2500") or time ("90 s"); default: default_budget(), or default_closings
  std::optional<std::string> seed;      ///< default: 1
  std::optional<std::string> seeds;     ///< how many searches; none: one
  std::optional<std::string> jobs;      ///< default: one per core
  bool resume = false;
  bool limit = false;  ///< compare the winner with the least time of any waveform, however long that takes
};

/// Of a search that the least time of any waveform, a second or two, does not make much longer.
inline constexpr long evaluations_worth_a_limit = 1000;

/// The scene that a search begins with, as its plan keeps it.
struct StartingScene {
  std::string name;  ///< as it was given
  SceneFile scene;   ///< canonical
};

/// A search, or several that differ in their seeds, ready to run.
struct PlannedSearch {
  SceneFile scene;
  OptimizeOptions options;                       ///< with the first of the seeds
  std::optional<RobustOptions> robust;           ///< of a search over devices by one measure
  std::optional<ForDevicesOptions> for_devices;  ///< of one that races measures and families
  std::vector<std::string> conditions;           ///< in the words of the options
  std::vector<StartingScene> starts;
  std::uint64_t seeds = 1;
  nlohmann::json plan;  ///< all that decides what is found, see plan_of()

  [[nodiscard]] std::uint64_t seed(std::uint64_t k) const { return options.seed + k; }
};

inline constexpr std::uint64_t most_seeds = 100'000;

/// Reads the options. `known` is the plan of the search that is gone on with, which has the word where an option is not given; a
/// null value where there is none. Throws InvalidInput with option, value and rule.
[[nodiscard]] PlannedSearch planned(const Common& c, const OptimizeRequest& given, const nlohmann::json& known);

/// Why a search that is asked for does not go on with one of the plan `there`, in words; empty where it does: they differ in
/// nothing but the budget, or the asked one has more seeds.
[[nodiscard]] std::string difference(const nlohmann::json& there, const nlohmann::json& asked);

/// Of a plan for one of its seeds alone, which is what decides the bits of that search.
[[nodiscard]] nlohmann::json plan_of_seed(const nlohmann::json& plan, std::uint64_t seed);

}  // namespace softland::apps
