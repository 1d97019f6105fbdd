// Computes the points of a part of an exploration's plan (the stored list of points) and stores them in a database file.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "studies/exploration/stored_exploration.h"

namespace softland {

/// The progress of an exploration.
struct ExplorationProgress {
  std::int64_t points = 0;  ///< number of points in this part of the exploration's plan
  std::int64_t known = 0;   ///< number of points that the database file had at the beginning
  std::int64_t computed = 0;
  std::int64_t reused = 0;     ///< number of rows copied from earlier explorations
  std::int64_t earlier = 0;    ///< number of rows of earlier explorations: at most this number can be copied
  double seconds = 0;          ///< time since the run began [s]
  double computing = 0;        ///< time since the computation of the first new point was begun [s]
  double waited_on_store = 0;  ///< total time for which threads waited for the database file [s]

  [[nodiscard]] std::int64_t there() const { return known + computed + reused; }
  [[nodiscard]] std::int64_t remaining() const { return points - there(); }
};

struct ExplorationRunnerOptions {
  Shard shard = {};
  int jobs = 1;
  /// Ends the exploration early when true; finished points are then in the database file.
  const std::atomic<bool>* stop = nullptr;
  /// Function that is called under a lock after every point.
  std::function<void(const ExplorationProgress&)> on_point = nullptr;
};

class ExplorationRunner {
 public:
  /// Keeps references to its arguments. `store` must belong to stored_plan(exploration, options.shard).
  ExplorationRunner(Exploration& exploration, StudyStore& store, const ExplorationRunnerOptions& options);

  /// Computes the points that the database file lacks. The rows do not depend on the number of threads. Throws the exceptions
  /// of StudyStore::add().
  void run();
  [[nodiscard]] ExplorationProgress progress() const;

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::int64_t point(std::int64_t i) const { return i * options_.shard.count + options_.shard.index - 1; }
  template <class Work>
  auto timed(Work&& work);
  [[nodiscard]] ExplorationProgress so_far() const;
  void take(std::int64_t k);
  void note_first();

  Exploration& exploration_;
  StudyStore& store_;
  ExplorationRunnerOptions options_;
  std::vector<bool> done_;
  bool reuses_;
  int inner_jobs_ = 1;
  Progress progress_;
  mutable std::mutex mutex_;  // guards the progress `told_`, and the time `first_computed_`
  ExplorationProgress told_;
  std::atomic<double> store_seconds_ = 0;
  Clock::time_point begin_ = Clock::now();
  std::optional<Clock::time_point> first_computed_;
};

}  // namespace softland
