// The log keeps the findings of a search current on disk while it runs.
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

/// The log writes best.toml and evaluations.csv among the unfinished results of a folder. Several threads may call it.
class SearchLog {
 public:
  /// `columns` are those of evaluations.csv. Writes the file with its header, so that a folder that is not writable ends the
  /// run before its first evaluation.
  SearchLog(ResultFolder& folder, FamilyColumns columns);

  /// Notes an evaluation for evaluations.csv.
  void evaluated(const Evaluation& evaluation);
  /// Notes a better scene; best.toml and evaluations.csv are rewritten whole, at most once a second.
  void improved(const SceneFile& best);
  /// Writes all pending notes.
  void flush();

  /// Call it after the last note only.
  [[nodiscard]] const std::map<long, Evaluation>& evaluations() const { return evaluations_; }

 private:
  void write();

  ResultFolder& folder_;
  FamilyColumns columns_;
  std::mutex mutex_;                        // guards the members below
  std::map<long, Evaluation> evaluations_;  // kept by index: this order does not depend on the number of jobs
  std::string best_;
  bool pending_ = false;
  std::chrono::steady_clock::time_point written_{};
};

}  // namespace softland
