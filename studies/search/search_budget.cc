#include "studies/search/search_budget.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "model/closing.h"
#include "studies/search/optimize.h"
#include "studies/search/search_setting.h"

namespace softland {
namespace {

class NoObserver final : public ClosingObserver {};

// Returns the waveforms at the first starting point; none for waveforms from the user's code, which may throw exceptions.
DriveWaveforms first_waveforms(const SearchSetting& setting) {
  const bool has_own = std::ranges::any_of(setting.space.drives(), [](const DriveSearch& drive) { return bool(drive.own); });
  return has_own ? DriveWaveforms() : setting.space.waveforms(setting.space.starts().front());
}

}  // namespace

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

ClosingWork closing_work(const SearchSetting& setting) {
  // Work of a right-hand side besides its quadrature points (points_beside), and the work that counts as 1 (usual_points), in
  // units of one quadrature point.
  constexpr double points_beside = 8, usual_points = 32;
  const Switch& model = setting.given.model;
  const double points = points_beside + static_cast<double>(model.quadrature().points());
  ClosingWork most;
  for (const DriveWaveforms& searched : {DriveWaveforms(), first_waveforms(setting)}) {
    const std::vector<Signal> signals = setting.given.applied(setting.drives(searched));
    NoObserver nobody;
    const Work work = observe_closing(model, signals, setting.run_of(signals), nobody).work;
    const double counted =
        static_cast<double>(work.rhs_evaluations) * points / usual_points * (1 + static_cast<double>(model.film_states()));
    if (counted > most.counted) most = {.counted = counted, .seconds = work.wall};
  }
  return most;
}

double usual_work(Shaped drives) { return drives == Shaped::piezo ? 8000 : 4000; }

long within_work(long closings, double counted, double usual) {
  if (!(counted > usual)) return closings;
  return std::max(1L, std::lround(static_cast<double>(closings) * usual / counted));
}

void fit_nominal_budget(const SearchSetting& setting, OptimizeOptions& options) {
  if (!options.counts_work && !options.on_estimate) return;
  constexpr double by_evaluation = 1.5;  // closings per evaluation: gradients and verification take another half
  const ClosingWork one = closing_work(setting);
  const long asked = options.max_evaluations;
  if (options.counts_work) {
    const double usual = usual_work(shaped_drives(setting.given.scene.file, options.actuator));
    options.max_evaluations = within_work(asked, one.counted, usual);
    options.more_evaluations = options.more_evaluations > 0 ? within_work(options.more_evaluations, one.counted, usual) : 0;
  }
  if (!options.on_estimate) return;
  const double seconds = by_evaluation * static_cast<double>(options.max_evaluations) * one.seconds;
  options.on_estimate({.closing = one.seconds,
                       .evaluations = options.max_evaluations,
                       .has_fewer = options.max_evaluations < asked,
                       .seconds = std::min(seconds, options.max_seconds * options.jobs)});
}

}  // namespace softland
