#include <fmt/format.h>

#include <cmath>

#include "base/random.h"
#include "base/require.h"
#include "optimizers/auto_search.h"
#include "optimizers/backends.h"
#include "optimizers/evaluation_record.h"
#include "optimizers/problem.h"
#include "optimizers/sobol.h"

namespace softland {
namespace internal {

RunReport run_method(const Method& method, const RunOptions& run, BudgetedObjective& budgeted) {
  if (method.backend == Backend::cma_es) return run_cma_es(run, budgeted);
  return method.backend == Backend::ipopt ? run_ipopt(run, budgeted) : run_nlopt(method, run, budgeted);
}

namespace {

void check(const Problem& problem, const OptimizerOptions& options) {
  require(!problem.variables.empty(), "a problem needs at least one variable");
  require(static_cast<bool>(problem.objective), "a problem needs an objective");
  for (const Variable& variable : problem.variables) {
    require(std::isfinite(variable.lower) && std::isfinite(variable.upper),
            fmt::format("variable \"{}\": bounds [{}, {}] must be finite", variable.name, variable.lower, variable.upper));
    require(variable.lower <= variable.upper, fmt::format("variable \"{}\": lower bound {} must not exceed upper bound {}",
                                                          variable.name, variable.lower, variable.upper));
  }
  for (const std::vector<double>& start : problem.starts) {
    require(start.size() == problem.variables.size(),
            fmt::format("a start has {} values; it must have {}, one per variable", start.size(), problem.variables.size()));
    for (std::size_t i = 0; i < start.size(); ++i) {
      require(std::isfinite(start[i]),
              fmt::format("variable \"{}\": start {} must be finite", problem.variables[i].name, start[i]));
    }
  }
  require(options.max_evaluations > 0, fmt::format("max_evaluations = {} must be positive", options.max_evaluations));
  require(options.max_seconds > 0, fmt::format("max_seconds = {} must be positive", options.max_seconds));
  require(options.step > 0 && options.step <= 1, fmt::format("step = {} must be in (0, 1]", options.step));
  require(options.population >= 1 && options.population <= 1000,
          fmt::format("population = {} must be in [1, 1000]", options.population));
  require(options.jobs >= 1, fmt::format("jobs = {} must be at least 1", options.jobs));
  require(!std::isnan(options.target), "target must not be NaN");
}

// Number of infeasible starts in succession that are skipped. From an infeasible start a local method sees only the constant
// penalty, while the next start costs one evaluation.
constexpr std::uint64_t infeasible_starts_skipped = 20;

// Number of local searches in succession that evaluate no new point, after which the minimisation ends.
constexpr int idle_runs_allowed = 20;

RunReport search_single_method(EvaluationRecord& record, const Method& method, const OptimizerOptions& options) {
  RunReport report;
  const auto body = [&](BudgetedObjective& budgeted) {
    int idle_runs = 0;
    std::uint64_t skipped = 0;
    const std::size_t given = record.starts().size();
    for (std::uint64_t k = 0; !budgeted.over() && idle_runs < idle_runs_allowed; ++k) {
      const RunOptions run{
          .start = k < given ? record.starts()[k] : sobol_points(record.seed(), record.dimension(), k - given, 1).front(),
          .step = options.step,
          .population = options.population,
          .seed = random_bits(record.seed(), Stream::library_seed, k)};
      const long before = budgeted.evaluations();
      if (method.reach == Reach::global) {
        report = run_method(method, run, budgeted);
        return;
      }
      if (!budgeted(run.start).feasible && skipped < infeasible_starts_skipped) {
        ++skipped;
        continue;
      }
      skipped = 0;
      report = run_method(method, run, budgeted);
      idle_runs = budgeted.evaluations() == before ? idle_runs + 1 : 0;
    }
  };
  record.run({{.budget = record.remaining(), .body = body}});
  return report;
}

void evaluate_starts(EvaluationRecord& record) {
  std::vector<EvaluationRecord::Task> tasks;
  for (const Point& start : record.starts())
    tasks.push_back({.budget = 1, .body = [&start](BudgetedObjective& budgeted) { budgeted(start); }});
  record.run(tasks);
}

}  // namespace
}  // namespace internal

std::string_view to_string(Termination termination) {
  switch (termination) {
    case Termination::not_run:
      return "not_run";
    case Termination::converged:
      return "converged";
    case Termination::target_reached:
      return "target_reached";
    case Termination::evaluation_budget:
      return "evaluation_budget";
    case Termination::time_budget:
      return "time_budget";
    case Termination::interrupted:
      return "interrupted";
    case Termination::no_feasible_point:
      return "no_feasible_point";
    case Termination::failure:
      return "failure";
  }
  return "unknown";
}

OptimizerResult minimize(const Problem& problem, const OptimizerOptions& options) {
  const internal::Method& method = internal::find_method(options.optimizer);
  internal::check(problem, options);

  internal::EvaluationRecord record(problem, options);
  internal::evaluate_starts(record);
  if (record.dimension() == 0) {
    record.run({{.budget = 1, .body = [](internal::BudgetedObjective& budgeted) { budgeted(internal::Point{}); }}});
    return record.result(true, "every variable is fixed: lower bound and upper bound are equal");
  }
  if (method.backend == internal::Backend::search_auto) {
    internal::search_auto(record);
    return record.result(true, "");
  }
  if (method.uses_gradient) {
    internal::search_and_finish(record, method);
    return record.result(true, "");
  }
  const internal::RunReport report = internal::search_single_method(record, method, options);
  return record.result(report.converged, report.message);
}

}  // namespace softland
