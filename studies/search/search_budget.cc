#include "studies/search/search_budget.h"

#include <algorithm>
#include <utility>

namespace softland {

SearchBudget::SearchBudget(BudgetLimits limits)
    : evaluations_(limits.evaluations),
      seconds_(limits.seconds),
      stop_(limits.stop),
      clock_(std::move(limits.clock)),
      begin_(clock_()) {}

SearchBudget::SearchBudget(SearchBudget& whole, long evaluations, double seconds)
    : whole_(&whole), evaluations_(evaluations), seconds_(seconds), stop_(whole.stop_), clock_(whole.clock_), begin_(clock_()) {}

void SearchBudget::took(long evaluations) {
  taken_ += evaluations;
  if (whole_ != nullptr) whole_->took(evaluations);
}

double SearchBudget::share_taken() const {
  return std::min(1.0, static_cast<double>(taken_) / static_cast<double>(evaluations_));
}

void SearchBudget::leave_out(const std::function<void()>& work) {
  const double before = clock_();
  work();
  begin_ += clock_() - before;
}

bool SearchBudget::out_of_time() const { return seconds_ < std::numeric_limits<double>::infinity() && elapsed() > seconds_; }

OptimizerResult minimize_within(SearchBudget& budget, const Problem& problem, std::uint64_t seed, int jobs,
                                const Progress& progress, std::string_view what) {
  OptimizerOptions options{.max_evaluations = budget.left(), .seed = seed, .jobs = jobs};
  options.stop = budget.stop();
  options.on_evaluation = [&](const Evaluation&) {
    budget.took(1);
    progress.tell(what, budget.share_taken());
  };
  return minimize(problem, options);
}

}  // namespace softland
