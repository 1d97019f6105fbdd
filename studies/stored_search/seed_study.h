// Searches from several seeds as one study: each is a row of a store as soon as it is done.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "objectives/figures.h"
#include "store/study_store.h"
#include "studies/search/optimize.h"
#include "studies/stored_search/evaluation_store.h"
#include "studies/stored_search/stored_search.h"

namespace softland {

/// What the search from one seed came to.
struct SearchOfSeed {
  std::uint64_t seed = 0;
  std::string status, termination;
  double cost = Metrics::unset, evaluations = Metrics::unset;
  bool goal_met = false, confirmed = false, better_than_baseline = false;
  FigureValues figures = {};  ///< of the waveform found
};

class SeedStudy {
 public:
  /// How far it is.
  struct State {
    std::uint64_t done = 0;  ///< of the seeds
    double part = 0;         ///< of all evaluations
    long evaluations = 0;    ///< of this run
    double best_cost = Metrics::unset, step_cost = Metrics::unset;
  };
  /// Told from any thread, one call at a time; either may be null.
  struct Listener {
    std::function<void(const State&)> progress = {};
    std::function<void(const SceneFile& best)> improvement = {};  ///< of all seeds
  };

  /// `variables`: the searched parameters. Opens the store of the seeds, whose rows are not computed again. Keeps references to
  /// search and evaluations. Throws as StudyStore does.
  SeedStudy(const StoredSearch& search, EvaluationStore& evaluations, const std::filesystem::path& file,
            std::vector<std::string> variables, const StoredOrigin& origin);

  /// Runs the searches that are missing, several at once where there are as many as threads. A search is the same on any number
  /// of them. Ends early when it is asked to stop.
  void run(const Listener& listener);
  /// Lets the store go.
  void close() { store_.close(); }

  /// The searches that are done, in the order of their seeds.
  [[nodiscard]] std::vector<SearchOfSeed> searches() const;
  /// What the search from this seed found, as a scene; empty where it found nothing.
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

  mutable std::mutex mutex_;  // of what follows
  std::vector<long> made_;    // evaluations, by seed, of those that are under way or done in this run
  std::uint64_t done_ = 0;
  double best_cost_ = Metrics::unset, step_cost_ = Metrics::unset;
};

}  // namespace softland
