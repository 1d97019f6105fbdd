// The record of a search, beside that of the closing that it found.
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

/// Another run of the winner.
struct ConfirmationRecord {
  std::string name, status;
  std::optional<FigureValues> figures;
  /// Tells whether it is under another gas law: it then differs in the simulated physics, not in the method.
  [[nodiscard]] bool is_of_gas() const { return name.starts_with("gas "); }
};

struct SearchCourse {
  std::string value_name;  ///< name of the value that the search minimises
  Points best_so_far;      ///< index of an evaluation, value
  Points evaluations;      ///< the same for all evaluations; a value is NaN where it was infeasible
};

/// The least time in which any waveform of the same drives and limits touches no faster than the winner.
struct TouchLimit {
  double least_time = Metrics::unset, impact_velocity = Metrics::unset;  ///< time [s] and velocity [m/s]
};

/// Searches that differ in their seeds alone; the result is that of the best.
struct SeedsFindings {
  std::uint64_t planned = 0;           ///< planned number of searches; those below are done
  std::vector<SearchOfSeed> searches;  ///< ascending by seed
  std::size_t best = 0;                ///< index of the best search
};

/// A member that is not available is NaN, empty or not set.
struct SearchRecord {
  std::string target, actuator, waveform, optimizer, termination, termination_message;
  std::vector<SearchedFamilyResult> families;  ///< empty unless there were several
  std::optional<std::uint64_t> seed;
  std::optional<bool> goal_met, better_than_baseline, plain_step_wins;
  double harder_than_step = Metrics::unset;  ///< see OptimizeResult
  double evaluations = Metrics::unset;
  RunRecord baseline;                                   ///< run of the plain step
  std::map<std::string, double> parameters;             ///< parameters of the winner, by drive.name
  std::map<std::string, std::array<double, 2>> bounds;  ///< the box in which they were searched
  std::vector<ConfirmationRecord> checks;
  double evaluations_of_modes = Metrics::unset;  ///< see OptimizeResult
  SearchCourse course;
  std::optional<RobustFindings> robust;
  std::optional<DevicesFindings> devices;
  std::optional<SeedsFindings> seeds;
  std::optional<TouchLimit> limit;
  std::vector<std::string> reproduce;  ///< command lines
};

}  // namespace softland
