// The folder a search leaves its findings in, kept current while the search runs: whatever happens, what is there is whole and
// readable.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "config/scene.h"
#include "optimizers/problem.h"

namespace softland::apps {

class SearchFolder {
 public:
  /// Creates the folder and removes what an earlier run left in it: only for a search that has been found valid. `variables` are
  /// the columns of evaluations.csv. Throws InvalidInput when the folder cannot be written to.
  SearchFolder(std::filesystem::path folder, std::vector<std::string> variables);

  /// Notes an evaluation for evaluations.csv.
  void evaluated(const Evaluation& evaluation);
  /// Notes a better scene; best.toml and evaluations.csv are rewritten whole, at most once a second.
  void improved(const SceneFile& best);
  /// Writes what is still only noted.
  void flush();

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  [[nodiscard]] const std::map<long, Evaluation>& evaluations() const { return evaluations_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> variables_;
  std::map<long, Evaluation> evaluations_;  // by index: the order that does not depend on the number of jobs
  std::string best_;
  bool pending_ = false;
  std::chrono::steady_clock::time_point written_{};
};

}  // namespace softland::apps
