// Searches that differ only in their seeds, as one study. The result of each search becomes a row of a database file as soon as
// the search ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "objectives/figure_values.h"
#include "store/study_store.h"
#include "studies/search/evaluation_store.h"
#include "studies/search/optimize.h"
#include "studies/search/stored_search.h"

namespace softland {

/// The result of the search from one seed.
struct SearchOfSeed {
  std::uint64_t seed = 0;
  std::string status, termination;
  double cost = Metrics::unset, evaluations = Metrics::unset;
  bool goal_met = false, confirmed = false, better_than_baseline = false;
  FigureValues figures = {};  ///< figures of merit of the closing under the waveform that was found
};

class SeedStudy {
 public:
  /// The progress of a study of several seeds.
  struct State {
    std::uint64_t done = 0;  ///< number of seeds whose search is finished
    double part = 0;         ///< evaluations of all seeds so far, as a share of those planned
    long evaluations = 0;    ///< number of evaluations of all seeds in this run of the program
    double best_cost = Metrics::unset, step_cost = Metrics::unset;
  };
  /// Callbacks of a study, which may be called from any thread, one call at a time. Either callback may be null.
  struct Listener {
    std::function<void(const State&)> progress = {};
    /// Function that receives the scene with the best waveform of all seeds.
    std::function<void(const SceneFile& best)> improvement = {};
  };

  /// Opens the database `file`; seeds that have a row in the file are not searched again. `variables` are the names of the
  /// searched parameters. Keeps references to `search` and `evaluations`. Throws the exceptions of the constructor of
  /// StudyStore.
  SeedStudy(const StoredSearch& search, EvaluationStore& evaluations, const std::filesystem::path& file,
            std::vector<std::string> variables, const StoredOrigin& origin);

  /// Runs the searches of the seeds that have no row, several at once if there are enough threads. The result of a search does
  /// not depend on the number of threads. Ends early if the search is interrupted.
  void run(const Listener& listener);
  /// Closes the database file of the study.
  void close() { store_.close(); }

  /// Returns the results of the finished searches, in the order of their seeds.
  [[nodiscard]] std::vector<SearchOfSeed> searches() const;
  /// Returns the text of the scene with the waveform that the search from `seed` found; empty if no waveform was found.
  [[nodiscard]] std::string scene_of(std::uint64_t seed) const;
  [[nodiscard]] std::uint64_t missing() const { return search_.seeds - done_; }
  [[nodiscard]] State state() const;

 private:
  void search(std::uint64_t k, int jobs, const Listener& listener);
  [[nodiscard]] StoredRow row(std::uint64_t k, const OptimizeResult& result, double closings) const;

  const StoredSearch& search_;
  EvaluationStore& evaluations_;
  std::vector<std::string> variables_;
  std::filesystem::path file_;
  StudyStore store_;
  std::vector<std::uint64_t> to_do_;

  mutable std::mutex mutex_;  // guards results and evaluation counts, which several searches update at once
  std::vector<long> made_;    // number of evaluations by seed, of searches in this run of the program
  std::uint64_t done_ = 0;
  double best_cost_ = Metrics::unset, step_cost_ = Metrics::unset;
};

}  // namespace softland
