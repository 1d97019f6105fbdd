// The record of a search, a part of the record of the closing that the search found.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reports/run_record.h"
#include "studies/search/devices_findings.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_optimize.h"
#include "studies/search/seed_study.h"

namespace softland {

/// A simulation of the best waveform with other settings.
struct ConfirmationRecord {
  std::string name, status;
  std::optional<FigureValues> figures;
  /// Returns true if the simulation has another gas law: it then differs in physics, not in the numerical method.
  [[nodiscard]] bool is_of_gas() const { return name.starts_with("gas "); }
};

struct SearchCourse {
  std::string value_name;  ///< name of the value that the search minimises
  Points best_so_far;      ///< index of an evaluation, least value until then
  Points evaluations;      ///< index of every evaluation, value; a value is NaN for an infeasible candidate
};

/// The least closing time of any waveform for the same drives and limits, with at most the impact velocity of the best
/// waveform.
struct TouchLimit {
  double least_time = Metrics::unset, impact_velocity = Metrics::unset;  ///< least time [s], permitted impact velocity [m/s]
};

/// Searches that differ only in their seeds; the result is that of the best search.
struct SeedsFindings {
  std::uint64_t planned = 0;           ///< planned number of searches
  std::vector<SearchOfSeed> searches;  ///< completed searches, ascending by seed
  std::size_t best = 0;                ///< index of the best search
};

/// The record of a search. A member that is not available is NaN, empty or not set.
struct SearchRecord {
  std::string target, actuator, waveform, optimizer, termination, termination_message;
  std::vector<SearchedFamilyResult> families;  ///< empty unless several families were searched
  std::optional<std::uint64_t> seed;
  std::optional<bool> goal_met, better_than_baseline, plain_step_wins;
  double harder_than_step = Metrics::unset;  ///< voltage or slew rate over that of the plain step, see OptimizeResult
  double evaluations = Metrics::unset;
  RunRecord baseline;                                   ///< run of the plain step
  std::map<std::string, double> parameters;             ///< parameters of the best waveform, by "drive.name"
  std::map<std::string, std::array<double, 2>> bounds;  ///< lower and upper bound of each parameter
  std::vector<ConfirmationRecord> checks;
  double evaluations_of_modes = Metrics::unset;  ///< evaluations with more modes, see OptimizeResult
  SearchCourse course;
  std::optional<RobustFindings> robust;
  std::optional<DevicesFindings> devices;
  std::optional<SeedsFindings> seeds;
  std::optional<TouchLimit> limit;
  std::vector<std::string> reproduce;  ///< command lines that reproduce the result
};

}  // namespace softland
