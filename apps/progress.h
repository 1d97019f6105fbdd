// How far a verb is, on standard error: a bar that is rewritten in place on a terminal, elsewhere a line every ten seconds.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <utility>

#include "studies/optimize.h"

namespace softland::apps {

class Bar {
 public:
  explicit Bar(bool quiet);

  /// The part that is done, 0 to 1, and words.
  using State = std::function<std::pair<double, std::string>(double elapsed)>;
  /// Prints `state` if it is time to; it is asked only then.
  void show(const State& state);
  /// Leaves the last state of the bar on the screen.
  void close(const State& state);

 private:
  void print(const State& state) const;

  bool terminal_, quiet_;
  std::chrono::steady_clock::time_point start_, shown_;
};

/// How far a search is.
class SearchProgress {
 public:
  SearchProgress(bool quiet, const OptimizeOptions& options);

  void show(const OptimizeProgress& progress);
  void close();

 private:
  [[nodiscard]] std::pair<double, std::string> state(double elapsed) const;

  Bar bar_;
  long budget_;
  double seconds_;
  OptimizeProgress progress_;
};

}  // namespace softland::apps
