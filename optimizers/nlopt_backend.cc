// Runs the methods of NLopt 2.7.1, which have properties that the interface of NLopt does not show:
// - NLopt's limits are not enough: several methods report success on NaN, hang, or swallow exceptions. So the BudgetedObjective
//   counts evaluations, keeps the best point and ends a run; only the message of NLopt's result is used.
// - Random numbers come from a generator of the calling thread, seeded from the clock unless nlopt::srand is called in it.
// - MLSL (multi-level single linkage) is used in the variant that starts from random points: the Sobol sequence of the other
//   variant cannot be seeded.
// - DIRECT (dividing rectangles) divides the box at fixed places; a nonlinear scale per variable, drawn from the seed, moves
//   these places.
#include <fmt/format.h>

#include <algorithm>
#include <nlopt.hpp>
#include <vector>

#include "base/random.h"
#include "optimizers/backends.h"

namespace softland::internal {
namespace {

// Step below which a local method of NLopt has converged, in units of the box of the variables. Differences of the objective
// over such a step are below its noise, so that no method ends too early in a narrow valley.
constexpr double step_tolerance = 1e-7;
// Step below which a local search inside MLSL has converged, in units of the box of the variables; MLSL finds many minima and
// needs only to distinguish them.
constexpr double step_tolerance_inside_mlsl = 1e-4;

struct Callback {
  BudgetedObjective& budgeted;
  bool with_conditions;  ///< true when the method uses the conditions of the problem
  /// Value of each variable of the problem at which NLopt's variable is 0.5, for DIRECT. Both variables are scaled to [0, 1],
  /// and each is a piecewise linear function of the other. Empty: NLopt's variables are those of the problem.
  std::vector<double> bent_middle;

  [[nodiscard]] Point to_point(const std::vector<double>& x) const {
    Point point = x;
    for (std::size_t i = 0; i < bent_middle.size(); ++i) {
      const double t = point[i];
      const double middle = bent_middle[i];
      point[i] = t < 0.5 ? 2 * middle * t : middle + (1 - middle) * (2 * t - 1);
    }
    return point;
  }
};

double call(const std::vector<double>& x, std::vector<double>& gradient, void* data) {
  Callback& callback = *static_cast<Callback*>(data);
  try {
    const Point point = callback.to_point(x);
    if (!gradient.empty()) {
      std::vector<double> gradients((1 + callback.budgeted.conditions()) * x.size());
      callback.budgeted.gradients(point, gradients);
      std::copy_n(gradients.begin(), x.size(), gradient.begin());
    }
    return callback.with_conditions ? callback.budgeted.values(point).all[0] : callback.budgeted(point).value;
  } catch (const Cut&) {
    throw nlopt::forced_stop();
  }
}

// Evaluates the conditions g_i <= 0 for NLopt's methods with a gradient. DIRECT is not among these methods, so that its
// nonlinear scale of the variables is not applied.
void call_conditions(unsigned count, double* values, unsigned dimension, const double* x, double* gradient, void* data) {
  BudgetedObjective& budgeted = static_cast<Callback*>(data)->budgeted;
  const std::span<const double> point(x, dimension);
  try {
    const std::vector<double> all = budgeted.values(point).all;
    std::copy_n(all.begin() + 1, count, values);
    if (gradient == nullptr) return;
    std::vector<double> gradients((1 + count) * std::size_t{dimension});
    budgeted.gradients(point, gradients);
    std::copy(gradients.begin() + dimension, gradients.end(), gradient);
  } catch (const Cut&) {
    throw nlopt::forced_stop();
  }
}

std::string_view name_of(nlopt::result result) {
  switch (result) {
    case nlopt::SUCCESS:
      return "SUCCESS";
    case nlopt::FTOL_REACHED:
      return "FTOL_REACHED";
    case nlopt::XTOL_REACHED:
      return "XTOL_REACHED";
    default:
      return "unexpected result";
  }
}

}  // namespace

RunReport run_nlopt(const Method& method, const RunOptions& run, BudgetedObjective& budgeted) {
  const auto algorithm = static_cast<nlopt::algorithm>(method.nlopt_algorithm);
  const bool is_mlsl = algorithm == nlopt::G_MLSL;
  const std::size_t conditions = method.uses_gradient ? budgeted.conditions() : 0;
  Callback callback{.budgeted = budgeted, .with_conditions = conditions > 0, .bent_middle = {}};
  std::vector<double> x = run.start;
  if (algorithm == nlopt::GN_DIRECT_L) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      callback.bent_middle.push_back(0.4 + 0.2 * random_uniform(run.seed, Stream::skew, i));
    }
  }

  budgeted.begin_search();
  const auto report = [&](bool converged, std::string_view words) {
    return RunReport{.converged = converged, .message = fmt::format("NLopt {}: {}", method.name, words)};
  };
  try {
    const auto dimension = static_cast<unsigned>(x.size());
    nlopt::opt opt(algorithm, dimension);
    opt.set_lower_bounds(0.0);
    opt.set_upper_bounds(1.0);
    opt.set_min_objective(call, &callback);
    if (conditions > 0) opt.add_inequality_mconstraint(call_conditions, &callback, std::vector<double>(conditions, 0.0));
    opt.set_initial_step(run.step);
    opt.set_xtol_abs(step_tolerance);
    if (is_mlsl) {
      nlopt::opt local(nlopt::LN_BOBYQA, dimension);
      local.set_xtol_abs(step_tolerance_inside_mlsl);
      local.set_initial_step(run.step);
      opt.set_local_optimizer(local);
    }
    nlopt::srand(static_cast<unsigned long>(run.seed));
    double value = 0;
    return report(true, name_of(opt.optimize(x, value)));
  } catch (const nlopt::forced_stop&) {
    return report(false, "stopped by softland");
  } catch (const nlopt::roundoff_limited&) {
    return report(true, "ROUNDOFF_LIMITED");
  } catch (const std::exception& exception) {
    return report(false, exception.what());
  }
}

}  // namespace softland::internal
