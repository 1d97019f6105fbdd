// The progress of a verb appears on standard error: a bar that is rewritten in place on a terminal, elsewhere a line after five
// seconds, and every ten from then on.
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

#include "apps/pace.h"
#include "base/monotone_progress.h"
#include "base/watch.h"
#include "studies/search/optimize.h"

namespace softland::apps {

class Bar {
 public:
  explicit Bar(bool quiet);

  /// A state is the part that is done, 0 to 1, and words.
  using State = std::function<std::pair<double, std::string>(double elapsed)>;
  /// Prints `state` if it is due; it is called only then.
  void show(const State& state);
  /// Leaves the last state of the bar on the screen.
  void close(const State& state);

 private:
  friend class WatchedWork;
  [[nodiscard]] bool due() const;
  [[nodiscard]] double elapsed() const;  // time since the start [s]
  void print(const State& state) const;

  bool terminal_, quiet_;
  std::chrono::steady_clock::time_point start_, shown_;
};

/// A computation that ends when the program is asked to stop and shows its progress; the destructor removes the bar.
class WatchedWork {
 public:
  WatchedWork(bool quiet, const std::atomic<bool>* stop);
  ~WatchedWork();
  WatchedWork(const WatchedWork&) = delete;
  WatchedWork& operator=(const WatchedWork&) = delete;

  [[nodiscard]] const Watch& watch() const { return watch_; }

 private:
  std::mutex mutex_;  // guards the members below: several threads may report
  Bar bar_;
  bool shown_ = false;
  MonotoneProgress progress_;
  WorkPace pace_;
  Watch watch_;
};

/// The progress of a search.
class SearchProgress {
 public:
  /// `counted` names the unit of the budget, "evaluations"; `of` are words before that.
  SearchProgress(bool quiet, const OptimizeOptions& options, std::string counted, std::string of = {});

  void show(const OptimizeProgress& progress);
  void close();

 private:
  [[nodiscard]] std::pair<double, std::string> state(double elapsed) const;

  Bar bar_;
  long budget_;
  double seconds_;
  std::string counted_, of_;
  OptimizeProgress progress_;
};

}  // namespace softland::apps
