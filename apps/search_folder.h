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
  /// Creates the folder. Throws InvalidInput when it cannot be written to.
  explicit SearchFolder(std::filesystem::path folder);

  /// Notes an evaluation for evaluations.csv.
  void evaluated(const Evaluation& evaluation);
  /// Notes a better scene; best.toml and evaluations.csv are rewritten whole, at most once a second.
  void improved(const SceneFile& best);
  /// Writes what is still only noted.
  void flush();

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  [[nodiscard]] const std::map<long, Evaluation>& evaluations() const { return evaluations_; }
  void name_variables(std::vector<std::string> names) { names_ = std::move(names); }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> names_;
  std::map<long, Evaluation> evaluations_;  // by index: the order that does not depend on the number of jobs
  std::string best_;
  bool pending_ = false;
  std::chrono::steady_clock::time_point written_{};
};

}  // namespace softland::apps
