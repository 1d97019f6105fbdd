// What a search has found so far, kept current on disk while it runs.
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

/// best.toml and evaluations.csv among the unfinished results of a folder. May be told from several threads.
class SearchLog {
 public:
  /// `columns`: of evaluations.csv. Writes the file with its header, so that a
  /// folder that takes none ends the run before its first evaluation.
  SearchLog(ResultFolder& folder, FamilyColumns columns);

  /// Notes an evaluation for evaluations.csv.
  void evaluated(const Evaluation& evaluation);
  /// Notes a better scene; best.toml and evaluations.csv are rewritten whole, at most once a second.
  void improved(const SceneFile& best);
  /// Writes what is still only noted.
  void flush();

  /// When nothing more is told.
  [[nodiscard]] const std::map<long, Evaluation>& evaluations() const { return evaluations_; }

 private:
  void write();

  ResultFolder& folder_;
  FamilyColumns columns_;
  std::mutex mutex_;                        // of what follows
  std::map<long, Evaluation> evaluations_;  // by index: the order that does not depend on the number of jobs
  std::string best_;
  bool pending_ = false;
  std::chrono::steady_clock::time_point written_{};
};

}  // namespace softland
