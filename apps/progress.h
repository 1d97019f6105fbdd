// Shows the progress of a verb on standard error: a terminal shows a bar that is rewritten in place; any other output gets a
// line after five seconds and then every ten seconds.
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

#include "apps/pace.h"
#include "base/monotone_progress.h"
#include "base/progress.h"
#include "studies/search/optimize.h"

namespace softland::apps {

class Bar {
 public:
  explicit Bar(bool quiet);

  /// A function that returns the state of a computation `elapsed` [s] after its start: the done share, 0 to 1, and a text.
  using State = std::function<std::pair<double, std::string>(double elapsed)>;
  /// Shows the progress that `state` returns, if the last update is long enough ago.
  void show(const State& state);
  /// Ends the display of the progress; the last state of the bar remains on the screen.
  void close(const State& state);

 private:
  friend class ShownWork;
  [[nodiscard]] bool due() const;
  [[nodiscard]] double elapsed() const;  // time since the display was started [s]
  void print(const State& state) const;

  bool terminal_, quiet_;
  std::chrono::steady_clock::time_point start_, shown_;
};

/// Watches a computation: shows its progress, and stops it after a signal to stop. The destructor removes the bar.
class ShownWork {
 public:
  ShownWork(bool quiet, const std::atomic<bool>* stop);
  ~ShownWork();
  ShownWork(const ShownWork&) = delete;
  ShownWork& operator=(const ShownWork&) = delete;

  [[nodiscard]] const Progress& progress() const { return progress_; }

 private:
  std::mutex mutex_;  // guards the display, as several threads may report progress
  Bar bar_;
  bool shown_ = false;
  MonotoneProgress monotone_;
  WorkPace pace_;
  Progress progress_;
};

/// Shows the progress of a search for a waveform.
class SearchProgress {
 public:
  /// `counted` is the unit of the budget, such as "evaluations"; `of` is the text in front of the progress.
  SearchProgress(bool quiet, const OptimizeOptions& options, std::string counted, std::string of = {});

  void show(const OptimizeProgress& progress);
  void close();

 private:
  [[nodiscard]] std::pair<double, std::string> state(double elapsed) const;

  Bar bar_;
  long budget_;
  double seconds_;
  std::string counted_, of_;
  WorkPace pace_;  // pace since the first evaluation: the time before it, for preparations, says nothing of the rest
  OptimizeProgress progress_;
};

}  // namespace softland::apps
