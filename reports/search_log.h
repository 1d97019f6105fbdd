// A log that writes the results of a search to files while the search runs.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "config/scene.h"
#include "optimizers/problem.h"
#include "reports/result_folder.h"
#include "studies/search/evaluation_memory.h"

namespace softland {

/// Writes best.toml and evaluations.csv to the unfinished results of a folder. Several threads may call the member functions.
class SearchLog {
 public:
  /// Writes evaluations.csv with these columns and no rows, so that a run with a folder that cannot be written ends before its
  /// first evaluation.
  SearchLog(ResultFolder& folder, FamilyColumns columns);

  /// Records an evaluation for evaluations.csv.
  void evaluated(const Evaluation& evaluation);
  /// Records a scene with a better waveform. best.toml and evaluations.csv are then written completely, but at most once a
  /// second.
  void improved(const SceneFile& best);
  /// Writes all evaluations and better scenes that are not yet on the disk.
  void flush();

  /// Returns the evaluations of the search by index; call it only after the last call of evaluated().
  [[nodiscard]] const std::map<long, Evaluation>& evaluations() const { return evaluations_; }

 private:
  void write();

  ResultFolder& folder_;
  FamilyColumns columns_;
  std::mutex mutex_;                        // guards evaluations and best scene, which several threads record
  std::map<long, Evaluation> evaluations_;  // evaluations by index, so that their order is the same for any number of threads
  std::string best_;
  bool pending_ = false;
  std::chrono::steady_clock::time_point written_{};
};

}  // namespace softland
