// The results of a search, a part of the results of the closing that the search found (closing_record.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "objectives/figure_values.h"
#include "reports/run_record.h"
#include "studies/search/devices_findings.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_optimize.h"
#include "studies/search/seed_study.h"

namespace softland {

/// A repeated simulation of the best waveform with other settings, which confirms its figures of merit.
struct ConfirmationRecord {
  std::string name, status;
  std::optional<FigureValues> figures;
  /// Returns true if the repeated simulation has another gas law: it then differs in physics, not in the numerical method.
  [[nodiscard]] bool is_of_gas() const { return name.starts_with("gas "); }
};

struct SearchCourse {
  std::string value_name;  ///< name of the value that the search minimises
  Points best_so_far;      ///< points (index of an evaluation, least minimised value up to this evaluation)
  Points evaluations;      ///< points (index, minimised value) of every evaluation; the value is NaN for an infeasible waveform
};

/// The least closing time of any waveform on the same electrodes and piezos, within the same voltage limits, with at most the
/// impact velocity of the best waveform.
struct TouchLimit {
  /// Least closing time [s], permitted impact velocity [m/s].
  double least_time = Metrics::unset, impact_velocity = Metrics::unset;
};

/// Searches that differ only in their seeds; the result is that of the best search.
struct SeedsFindings {
  std::uint64_t planned = 0;           ///< planned number of searches, one per seed
  std::vector<SearchOfSeed> searches;  ///< results of the completed searches, ascending by seed
  std::size_t best = 0;                ///< index in `searches` of the best search
};

/// The results of a search. A member that is not available is NaN, empty or not set.
struct SearchRecord {
  std::string target, actuator, waveform, optimizer, termination, termination_message;
  std::vector<SearchedFamilyResult> families;  ///< results by waveform family; empty unless several families were searched
  std::optional<std::uint64_t> seed;
  std::optional<bool> goal_met, better_than_baseline, plain_step_wins;
  /// Largest relative excess of the best waveform over the plain step in impact velocity, peak contact force or impact energy;
  /// 0: none.
  double harder_than_step = Metrics::unset;
  double evaluations = Metrics::unset;
  RunRecord baseline;                                   ///< run under the plain step, with which the search compares
  std::map<std::string, double> parameters;             ///< parameters of the best waveform, by names such as "main.level_1_V"
  std::map<std::string, std::array<double, 2>> bounds;  ///< lower and upper bound between which each parameter was searched
  std::vector<ConfirmationRecord> checks;
  double evaluations_of_modes = Metrics::unset;  ///< number of further evaluations, each with several numbers of modes
  SearchCourse course;
  std::optional<RobustFindings> robust;
  std::optional<DevicesFindings> devices;
  std::optional<SeedsFindings> seeds;
  std::optional<TouchLimit> limit;
  std::vector<std::string> reproduce;  ///< command lines that reproduce the result of the search
};

}  // namespace softland
