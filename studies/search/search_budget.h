// The budget of a search: evaluations of one switch or closings of devices, and time. A flag from outside ends it earlier.
//
// A search in stages gives every stage a part of its budget. Evaluations of a part count for the whole budget, too. A part ends
// when its own time is up, or when the whole budget is given up. All parts use the same clock, which a test can replace.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>

#include "base/clock.h"
#include "base/progress.h"
#include "optimizers/problem.h"

namespace softland {

/// The size of a budget.
struct BudgetLimits {
  long evaluations = std::numeric_limits<long>::max();       ///< evaluations, or closings of devices
  double seconds = std::numeric_limits<double>::infinity();  ///< time from the construction of the budget on [s]
  const std::atomic<bool>* stop = nullptr;                   ///< flag from outside (Ctrl-C); may be null
  std::function<double()> clock = wall_clock;                ///< clock for the time [s]
};

/// A budget, and what has been taken from it. Several threads may use it at once.
class SearchBudget {
 public:
  explicit SearchBudget(BudgetLimits limits);
  /// Makes a part of `whole`, which must outlive it. It has as much time as the whole budget has left.
  SearchBudget(SearchBudget& whole, long evaluations) : SearchBudget(whole, evaluations, whole.seconds_left()) {}
  /// Makes a part that has its own time, from now on [s].
  SearchBudget(SearchBudget& whole, long evaluations, double seconds);

  /// Counts evaluations of this part and of the whole budget.
  void took(long evaluations);
  [[nodiscard]] long taken() const { return taken_; }
  /// Number of evaluations that are left; negative after the last candidate took more than that.
  [[nodiscard]] long left() const { return evaluations_ - taken_; }
  /// Share of the evaluations that is taken, 0 to 1.
  [[nodiscard]] double share_taken() const;
  /// Changes the number of evaluations.
  void allow(long evaluations) { evaluations_ = evaluations; }

  /// The time of the budget [s]; infinite without a limit.
  [[nodiscard]] double seconds() const { return seconds_; }
  /// Time since the budget was made [s].
  [[nodiscard]] double elapsed() const { return clock_() - begin_; }
  /// Time until this share of the budget's time has passed [s]; infinite without a limit, negative afterwards.
  [[nodiscard]] double seconds_left(double share = 1) const { return share * seconds_ - elapsed(); }
  /// Does some work whose time does not count.
  void leave_out(const std::function<void()>& work);

  /// Ends this budget and its parts; may be called from any thread.
  void give_up() { given_up_ = true; }
  [[nodiscard]] bool given_up() const { return given_up_ || (whole_ != nullptr && whole_->given_up()); }
  /// True once the flag from outside is set.
  [[nodiscard]] bool interrupted() const { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }
  [[nodiscard]] bool out_of_time() const;
  /// True if the search has to end, whatever evaluations are left.
  [[nodiscard]] bool over() const { return interrupted() || given_up() || out_of_time(); }
  [[nodiscard]] const std::atomic<bool>* stop() const { return stop_; }

 private:
  SearchBudget* whole_ = nullptr;  // null for a budget that is not a part
  std::atomic<long> evaluations_, taken_ = 0;
  double seconds_;  // [s]
  const std::atomic<bool>* stop_;
  std::function<double()> clock_;
  double begin_;  // [s]
  std::atomic<bool> given_up_ = false;
};

/// Minimises within the evaluations of a budget, on `jobs` threads. `progress` is told of the share that is taken, under the
/// name `what`.
[[nodiscard]] OptimizerResult minimize_within(SearchBudget& budget, const Problem& problem, std::uint64_t seed, int jobs,
                                              const Progress& progress, std::string_view what);

}  // namespace softland
