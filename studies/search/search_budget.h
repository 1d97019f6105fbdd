// The budget of a search: a number of evaluations of one switch or of closings of devices, and a time. A flag from outside
// (Ctrl-C) ends the search earlier.
//
// A search in stages gives every stage a part of its budget. Evaluations of a part count for the whole budget, too. A part is
// over when its own time has passed, or after give_up() of the whole budget. All parts use one clock, which a test can replace.
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

/// The limits of a budget: evaluations, time and a flag.
struct BudgetLimits {
  long evaluations = std::numeric_limits<long>::max();       ///< largest number of evaluations, or of closings of devices
  double seconds = std::numeric_limits<double>::infinity();  ///< time from the construction of the budget on [s]
  const std::atomic<bool>* stop = nullptr;                   ///< flag from outside (Ctrl-C) that ends the search; may be null
  std::function<double()> clock = wall_clock;                ///< clock that measures the time [s]
};

/// A budget, and the evaluations spent so far. Several threads may use the same budget.
class SearchBudget {
 public:
  explicit SearchBudget(BudgetLimits limits);
  /// Constructs a part of the budget `whole`, which must outlive the part, with all the time that `whole` has left.
  SearchBudget(SearchBudget& whole, long evaluations) : SearchBudget(whole, evaluations, whole.seconds_left()) {}
  /// Constructs a part of the budget `whole` with its own time `seconds` from now on [s].
  SearchBudget(SearchBudget& whole, long evaluations, double seconds);

  /// Adds to the evaluations spent, of this budget and of the whole one.
  void took(long evaluations);
  [[nodiscard]] long taken() const { return taken_; }
  /// Number of evaluations that are left; negative if the last candidate used more than were left.
  [[nodiscard]] long left() const { return evaluations_ - taken_; }
  /// Share of the evaluations that is spent, 0 to 1.
  [[nodiscard]] double share_taken() const;
  /// Changes the number of evaluations in the budget.
  void allow(long evaluations) { evaluations_ = evaluations; }

  /// The time of the budget [s]; infinite without a limit.
  [[nodiscard]] double seconds() const { return seconds_; }
  /// Time since the construction of the budget [s].
  [[nodiscard]] double elapsed() const { return clock_() - begin_; }
  /// Time until `share` of the budget's time has passed [s]; infinite without a limit, negative after that time.
  [[nodiscard]] double seconds_left(double share = 1) const { return share * seconds_ - elapsed(); }
  /// Does `work`, whose time does not count for the budget.
  void leave_out(const std::function<void()>& work);

  /// Ends the search with this budget and its parts; may be called from any thread.
  void give_up() { given_up_ = true; }
  [[nodiscard]] bool given_up() const { return given_up_ || (whole_ != nullptr && whole_->given_up()); }
  /// True if the flag from outside (Ctrl-C) is set.
  [[nodiscard]] bool interrupted() const { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }
  [[nodiscard]] bool out_of_time() const;
  /// True if the search has to end even if evaluations are left.
  [[nodiscard]] bool over() const { return interrupted() || given_up() || out_of_time(); }
  [[nodiscard]] const std::atomic<bool>* stop() const { return stop_; }

 private:
  SearchBudget* whole_ = nullptr;  // null for a budget that is not a part
  std::atomic<long> evaluations_, taken_ = 0;
  double seconds_;  // time of the budget [s]
  const std::atomic<bool>* stop_;
  std::function<double()> clock_;
  double begin_;  // time of the clock at construction [s]
  std::atomic<bool> given_up_ = false;
};

/// Minimises the objective of `problem` within the evaluations of a budget, on `jobs` threads. `progress` receives the spent
/// share under the name `what`.
[[nodiscard]] OptimizerResult minimize_within(SearchBudget& budget, const Problem& problem, std::uint64_t seed, int jobs,
                                              const Progress& progress, std::string_view what);

}  // namespace softland
