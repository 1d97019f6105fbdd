// The budget of a search: a number of evaluations of one switch or of closings of devices, and a time. A flag from outside
// (Ctrl-C) ends the search earlier. A default budget counts the work of a closing.
//
// A search in stages gives every stage a part of its budget. Evaluations of a part count for the whole budget, too. A part is
// over when its own time has passed, or after give_up() of the whole budget. All parts use one clock, which a test can replace.
//
// A default budget has fewer closings if the closings of the scene are slow. Work is counted in evaluations of the right-hand
// side of the equations of motion, whose number is the same on every machine and for every number of threads:
//
//   w   right-hand sides of a closing of the nominal device, the larger number of those under the plain step and under the first
//       waveform of the search. A right-hand side at p quadrature points counts as (8 + p) / 32; with a compressible gas film,
//       as many times more as the film has pressures, whose equations are solved as well
//   N   closings of the default budget, n = N min(1, u / w),  u = usual_work()
//
// A closing that cannot be simulated in SIMD lanes, several devices at a time (why_not_in_lanes()), counts usual_lanes times.
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

struct OptimizeOptions;  // optimize.h
struct SearchSetting;    // search_setting.h

/// The limits of a search's budget: evaluations, time and a flag.
struct BudgetLimits {
  /// Largest number of evaluations of one switch, or of closings of devices.
  long evaluations = std::numeric_limits<long>::max();
  /// Time that the search may take from the construction of the budget on [s].
  double seconds = std::numeric_limits<double>::infinity();
  const std::atomic<bool>* stop = nullptr;     ///< flag that another thread sets (Ctrl-C) to end the search; may be null
  std::function<double()> clock = wall_clock;  ///< clock that measures the time of the budget [s]
};

/// The budget of a search, and the evaluations spent so far. Several threads may use the same budget.
class SearchBudget {
 public:
  explicit SearchBudget(BudgetLimits limits);
  /// Constructs a part of the budget `whole`, which must outlive the part, with all the time that `whole` has left.
  SearchBudget(SearchBudget& whole, long evaluations) : SearchBudget(whole, evaluations, whole.seconds_left()) {}
  /// Constructs a part of the budget `whole` with its own time `seconds` from now on [s].
  SearchBudget(SearchBudget& whole, long evaluations, double seconds);

  /// Adds to the evaluations spent, of this budget and of the whole budget of which it is a part.
  void took(long evaluations);
  [[nodiscard]] long taken() const { return taken_; }
  /// Returns the number of evaluations that are left; negative if the last candidate waveform used more than were left.
  [[nodiscard]] long left() const { return evaluations_ - taken_; }
  /// Returns the share of the evaluations that is spent, 0 to 1.
  [[nodiscard]] double share_taken() const;
  /// Sets the number of evaluations of this budget, including those already spent.
  void allow(long evaluations) { evaluations_ = evaluations; }

  /// Returns the time of the budget [s]; infinite without a limit.
  [[nodiscard]] double seconds() const { return seconds_; }
  /// Returns the time since the construction of the budget [s].
  [[nodiscard]] double elapsed() const { return clock_() - begin_; }
  /// Returns the time left until the given share of the budget's time has passed [s]; infinite without a limit, negative after
  /// that time.
  [[nodiscard]] double seconds_left(double share = 1) const { return share * seconds_ - elapsed(); }
  /// Calls work(), whose time does not count for the budget.
  void leave_out(const std::function<void()>& work);

  /// Ends the search by this budget and by its parts early; may be called from any thread.
  void give_up() { given_up_ = true; }
  [[nodiscard]] bool given_up() const { return given_up_ || (whole_ != nullptr && whole_->given_up()); }
  /// True if another thread has set the flag that ends the search (Ctrl-C).
  [[nodiscard]] bool interrupted() const { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }
  [[nodiscard]] bool out_of_time() const;
  /// True if the search with this budget has to end even if evaluations are left.
  [[nodiscard]] bool over() const { return interrupted() || given_up() || out_of_time(); }
  [[nodiscard]] const std::atomic<bool>* stop() const { return stop_; }

 private:
  SearchBudget* whole_ = nullptr;  // budget of which this budget is a part; null for a budget that is not a part
  std::atomic<long> evaluations_, taken_ = 0;
  double seconds_;  // time that the search may take [s]
  const std::atomic<bool>* stop_;
  std::function<double()> clock_;
  double begin_;  // time of the clock at the construction of the budget [s]
  std::atomic<bool> given_up_ = false;
};

/// Minimises the objective of `problem` within the evaluations of a budget, on `jobs` threads. `progress` receives the spent
/// share under the name `what`.
[[nodiscard]] OptimizerResult minimize_within(SearchBudget& budget, const Problem& problem, std::uint64_t seed, int jobs,
                                              const Progress& progress, std::string_view what);

/// The work of simulating one closing, as a number and as a time.
struct ClosingWork {
  double counted = 0;  ///< work w of the closing, in right-hand sides of the equations of motion
  double seconds = 0;  ///< computing time of the closing on this machine [s]
};
/// Simulates the closings under the plain step and under the first starting waveform of the waveform family, with the options
/// of a search, and returns the work of the slower one. Throws no exception: a simulation that fails counts up to its failure.
[[nodiscard]] ClosingWork closing_work(const SearchSetting& setting);

/// Returns the reference u for the work of a closing, in right-hand sides: a default budget is reduced if closings take more.
[[nodiscard]] double usual_work(Shaped drives);
/// Number of devices that SIMD lanes simulate in the time of one device.
inline constexpr double usual_lanes = 8;

/// Computing time of a closing in a search over devices, relative to that of a single closing (device_share; measured: 0.6 to
/// 1.3). Computing time of a quasi-static closing, relative to that of a quick one (slow_approach).
inline constexpr double device_share = 0.8, slow_approach = 3;

/// Returns the number of closings that a default budget of `closings` is reduced to if each takes the work `counted`, more than
/// the reference `usual` [right-hand sides]; at least 1.
[[nodiscard]] long within_work(long closings, double counted, double usual);

/// Reduces a default budget of the search on the nominal device if the closings of the scene are slow, and reports the estimated
/// work.
void fit_nominal_budget(const SearchSetting& setting, OptimizeOptions& options);

}  // namespace softland
