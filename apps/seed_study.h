// Searches from several seeds as one study: each is a row of a store as soon as it is done.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "apps/progress.h"
#include "apps/search_log.h"
#include "apps/search_run.h"
#include "reports/result.h"
#include "store/study_store.h"

namespace softland::apps {

class SeedStudy {
 public:
  /// `variables`: the searched parameters. Opens the store of the seeds, whose rows are not computed again.
  SeedStudy(const Common& common, const KeptSearch& search, SearchPlaces& places, std::vector<std::string> variables);

  /// Runs the searches that are missing, several at once where there are as many as threads. A search is the same on any number
  /// of them. Ends early when it is asked to stop.
  void run();
  /// Lets the store go.
  void close();

  /// The searches that are done, ranked.
  [[nodiscard]] ResultSeeds found(double significant) const;
  /// What the best of them found, as a scene; empty where it found nothing.
  [[nodiscard]] std::string best_scene(const ResultSeeds& seeds) const;
  [[nodiscard]] std::uint64_t missing() const;

 private:
  void search(std::uint64_t k, int jobs);
  [[nodiscard]] StoredRow row(std::uint64_t k, const OptimizeResult& result, double closings) const;
  void improved(double cost, const SceneFile& best);
  void show();
  [[nodiscard]] std::pair<double, std::string> state(double elapsed) const;

  const Common& common_;
  const KeptSearch& search_;
  SearchPlaces& places_;
  std::vector<std::string> variables_;
  std::filesystem::path file_;
  StudyStore store_;
  std::vector<std::uint64_t> to_do_;

  mutable std::mutex mutex_;  // of what follows
  SearchLog log_;
  Bar bar_;
  std::vector<long> evaluations_;  // by seed, of those that are under way or done in this run
  std::uint64_t done_ = 0;
  double best_cost_, step_cost_;
};

}  // namespace softland::apps
