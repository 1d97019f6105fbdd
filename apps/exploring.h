// The points of a part of a plan on their way into its store.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/options.h"
#include "apps/progress.h"
#include "base/watch.h"
#include "store/study_store.h"
#include "studies/exploration.h"

namespace softland::apps {

class Exploring {
 public:
  Exploring(Exploration& exploration, StudyStore& store, const Shard& shard, const Common& common, int jobs);

  /// How many points the part has, and how many of them the store still lacks.
  [[nodiscard]] std::int64_t of_shard() const;
  [[nodiscard]] std::int64_t remaining() const { return of_shard() - known_ - computed_ - reused_; }

  /// Ends when all points are there, or it is asked to stop.
  void run();
  [[nodiscard]] nlohmann::json data() const;
  [[nodiscard]] std::string text(const std::string& out) const;

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::int64_t point(std::int64_t i) const { return i * shard_.count + shard_.index - 1; }
  template <class Work>
  auto timed(Work&& work);
  void take(std::int64_t k);
  void note_first();
  [[nodiscard]] std::pair<double, std::string> state(double elapsed) const;

  Exploration& exploration_;
  StudyStore& store_;
  Shard shard_;
  std::vector<bool> done_;
  bool reuses_;
  int jobs_, inner_jobs_ = 1;
  Watch watch_;
  std::mutex mutex_;  // of the bar, and of the time when computing began
  Bar bar_;
  std::int64_t known_ = 0;
  std::atomic<std::int64_t> computed_ = 0, reused_ = 0;
  std::atomic<double> store_seconds_ = 0;  // spent waiting for the store, by all threads [s]
  std::int64_t earlier_;                   // rows of earlier plans
  Clock::time_point begin_ = Clock::now();
  std::optional<Clock::time_point> first_computed_;  // when the first point was begun that had to be
  double seconds_ = 0;                               // [s]
};

}  // namespace softland::apps
