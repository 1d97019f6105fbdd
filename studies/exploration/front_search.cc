#include "studies/exploration/front_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "base/progress.h"
#include "optimizers/nsga2.h"

namespace softland {
namespace {

// Number of points of a generation, the same for any total number, so that a longer search begins with the points of a shorter
// one.
constexpr std::size_t population = 60;

// Constraint violations of points with an incomplete closing, and of impossible points. The genetic algorithm NSGA-II prefers
// the smaller violation.
constexpr double not_done = 1, impossible = 2;

class FrontSearch {
 public:
  FrontSearch(Exploration& exploration, StudyStore& store, KnownRows known, const std::vector<ExploredAim>& aims,
              const FrontOptions& options)
      : exploration_(exploration),
        store_(store),
        known_(std::move(known)),
        aims_(aims),
        options_(options),
        progress_{.stop = options.stop},
        found_{.points = static_cast<std::int64_t>(exploration.plan().points()),
               .known = static_cast<std::int64_t>(known_.size())} {}

  FrontFound run() {
    ParetoProblem problem{.objectives = aims_.size(),
                          .evaluate = [this](std::span<const double> place) { return evaluate(place); }};
    for (const PlanVariable& v : exploration_.plan().variables()) problem.variables.push_back({.name = v.name});
    found_.termination = minimize_all(problem, {.population = population,
                                                .max_evaluations = static_cast<long>(found_.points),
                                                .seed = exploration_.plan().seed(),
                                                .jobs = options_.jobs,
                                                .stop = options_.stop,
                                                .on_evaluation = [this](const ParetoEvaluation& e) { evaluated(e); }})
                             .termination;
    return found_;
  }

 private:
  [[nodiscard]] ParetoValue value_of(const StoredRow& row) const {
    ParetoValue value{.objectives = {}, .violation = may_lead(row.status) ? 0 : row.status == infeasible ? impossible : not_done};
    for (const ExploredAim& aim : aims_) value.objectives.push_back((aim.is_largest ? -1 : 1) * row.values[aim.column]);
    for (double& objective : value.objectives) {
      if (std::isfinite(objective)) continue;
      objective = 0;
      value.violation = std::max(value.violation, not_done);
    }
    return value;
  }

  [[nodiscard]] StoredRow row_at(const std::vector<double>& values) {
    if (const auto found = known_.find(values); found != known_.end()) return found->second;
    const SceneFile scene = exploration_.plan().scene(values);
    const ContentKey content = content_key(exploration_.content(scene));
    if (auto earlier = store_.find(content)) return *std::move(earlier);
    StoredRow row = stored_row(0, content, values, exploration_.row(scene, 1, progress_));
    const std::scoped_lock lock(mutex_);
    ++found_.computed;
    return row;
  }

  ParetoValue evaluate(std::span<const double> place) {
    StoredRow row = row_at(exploration_.plan().values_in_box({place.begin(), place.end()}));
    ParetoValue value = value_of(row);
    const std::scoped_lock lock(mutex_);
    fresh_.emplace(std::vector<double>(place.begin(), place.end()), std::move(row));
    return value;
  }

  void evaluated(const ParetoEvaluation& evaluation) {
    StoredRow row;
    {
      const std::scoped_lock lock(mutex_);
      const auto found = fresh_.find(evaluation.x);
      if (found == fresh_.end()) return;  // the point has no row: the search was stopped, or its computation failed
      row = std::move(found->second);
      fresh_.erase(found);
      ++found_.asked;
    }
    row.point = evaluation.index;
    store_.add(std::move(row));
    const std::scoped_lock lock(mutex_);
    if (options_.on_point) options_.on_point(found_);
  }

  Exploration& exploration_;
  StudyStore& store_;
  KnownRows known_;
  const std::vector<ExploredAim>& aims_;
  const FrontOptions& options_;
  Progress progress_;
  std::mutex mutex_;
  // Computed rows by position in the search box. A row is stored when the search reports the number of its point.
  std::map<std::vector<double>, StoredRow> fresh_;
  FrontFound found_;
};

}  // namespace

std::vector<ExploredAim> aims_of(const Exploration& exploration) {
  return explored_aims(explored_columns(stored_plan(exploration, {})), exploration.plan().pareto());
}

FrontFound search_front(Exploration& exploration, StudyStore& store, KnownRows known, const std::vector<ExploredAim>& aims,
                        const FrontOptions& options) {
  return FrontSearch(exploration, store, std::move(known), aims, options).run();
}

}  // namespace softland
