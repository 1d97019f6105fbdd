// Ipopt 3.11.9 as a quasi-Newton method for a minimisation under bounds and conditions. Ipopt shortens its steps, thousands of
// times, when the objective cannot be evaluated. So the BudgetedObjective counts the evaluations and ends the run by the
// exception Cut. Ipopt catches Cut, like every exception of a callback, and returns NonIpopt_Exception_Thrown.
#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <vector>

#include "optimizers/backends.h"
#include "optimizers/ipopt_turn.h"

namespace softland::internal {
namespace {

class StrandProblem final : public Ipopt::TNLP {
 public:
  StrandProblem(const Point& start, BudgetedObjective& budgeted) : start_(start), strand_(budgeted) {}

  bool get_nlp_info(Ipopt::Index& n, Ipopt::Index& m, Ipopt::Index& jacobian_entries, Ipopt::Index& hessian_entries,
                    IndexStyleEnum& index_style) override {
    n = static_cast<Ipopt::Index>(start_.size());
    m = static_cast<Ipopt::Index>(strand_.conditions());
    jacobian_entries = n * m;
    hessian_entries = 0;
    index_style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Ipopt::Index n, Ipopt::Number* lower, Ipopt::Number* upper, Ipopt::Index m, Ipopt::Number* least,
                       Ipopt::Number* most) override {
    constexpr double unbounded = -2e19;  // Ipopt takes values beyond -1e19 as unbounded
    std::fill_n(lower, n, 0.0);
    std::fill_n(upper, n, 1.0);
    std::fill_n(least, m, unbounded);
    std::fill_n(most, m, 0.0);
    return true;
  }
  bool get_starting_point(Ipopt::Index, bool, Ipopt::Number* x, bool, Ipopt::Number*, Ipopt::Number*, Ipopt::Index, bool,
                          Ipopt::Number*) override {
    std::copy(start_.begin(), start_.end(), x);
    return true;
  }
  bool eval_f(Ipopt::Index n, const Ipopt::Number* x, bool, Ipopt::Number& value) override {
    value = strand_.values(view(x, n)).all[0];
    return true;
  }
  bool eval_grad_f(Ipopt::Index n, const Ipopt::Number* x, bool, Ipopt::Number* gradient) override {
    std::copy_n(gradients(x, n).begin(), n, gradient);
    return true;
  }
  bool eval_g(Ipopt::Index n, const Ipopt::Number* x, bool, Ipopt::Index m, Ipopt::Number* values) override {
    if (m > 0) std::copy_n(strand_.values(view(x, n)).all.begin() + 1, m, values);
    return true;
  }
  // Provides the gradients of the conditions g_i; their Jacobian is dense. If `values` is null, Ipopt requests the row and
  // column of every entry instead.
  bool eval_jac_g(Ipopt::Index n, const Ipopt::Number* x, bool, Ipopt::Index m, Ipopt::Index, Ipopt::Index* rows,
                  Ipopt::Index* columns, Ipopt::Number* values) override {
    if (m == 0) return true;
    if (values != nullptr) {
      std::copy_n(gradients(x, n).begin() + n, n * m, values);
      return true;
    }
    for (Ipopt::Index k = 0; k < n * m; ++k) rows[k] = k / n, columns[k] = k % n;
    return true;
  }
  bool intermediate_callback(Ipopt::AlgorithmMode, Ipopt::Index, Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Number,
                             Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    return !strand_.over();
  }
  void finalize_solution(Ipopt::SolverReturn, Ipopt::Index, const Ipopt::Number*, const Ipopt::Number*, const Ipopt::Number*,
                         Ipopt::Index, const Ipopt::Number*, const Ipopt::Number*, Ipopt::Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {}

 private:
  static std::span<const double> view(const Ipopt::Number* x, Ipopt::Index n) { return {x, static_cast<std::size_t>(n)}; }
  // Returns the gradient of the objective, then that of each condition.
  [[nodiscard]] std::vector<double> gradients(const Ipopt::Number* x, Ipopt::Index n) {
    std::vector<double> all((1 + strand_.conditions()) * static_cast<std::size_t>(n));
    strand_.gradients(view(x, n), all);
    return all;
  }

  const Point& start_;
  BudgetedObjective& strand_;
};

RunReport report_of(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return {.converged = true, .message = "Ipopt: Solve_Succeeded"};
    case Ipopt::Solved_To_Acceptable_Level:
      return {.converged = true, .message = "Ipopt: Solved_To_Acceptable_Level"};
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return {.converged = true, .message = "Ipopt: Search_Direction_Becomes_Too_Small"};
    case Ipopt::Maximum_Iterations_Exceeded:
      return {.converged = false, .message = "Ipopt: Maximum_Iterations_Exceeded"};
    case Ipopt::Restoration_Failed:
      return {.converged = false, .message = "Ipopt: Restoration_Failed"};
    case Ipopt::Error_In_Step_Computation:
      return {.converged = false, .message = "Ipopt: Error_In_Step_Computation"};
    case Ipopt::User_Requested_Stop:
    case Ipopt::NonIpopt_Exception_Thrown:
      return {.converged = false, .message = "Ipopt: stopped by softland"};
    default:
      return {.converged = false, .message = "Ipopt: status " + std::to_string(static_cast<int>(status))};
  }
}

}  // namespace

RunReport run_ipopt(const RunOptions& run, BudgetedObjective& budgeted) {
  const auto turn = ipopt_turn([&] { return budgeted.over(); });
  if (!turn) return {.converged = false, .message = "Ipopt: stopped by softland while waiting for another solve"};
  budgeted.begin_search();
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(/*create_console_out=*/false);
  const auto options = application->Options();
  options->SetIntegerValue("print_level", 0);
  options->SetStringValue("sb", "yes");
  options->SetStringValue("hessian_approximation", "limited-memory");
  options->SetNumericValue("bound_relax_factor", 0.0);  // 0: Ipopt never evaluates points outside the bounds
  // Starts are good points, some of them near a bound. With Ipopt's default barrier parameter, the first steps would move a
  // start to the middle of the box.
  options->SetNumericValue("mu_init", 1e-4);
  options->SetNumericValue("bound_push", 1e-6);
  options->SetNumericValue("bound_frac", 1e-6);
  options->SetNumericValue("tol", 1e-6);  // convergence tolerance, reachable with gradients from finite differences
  options->SetIntegerValue("max_iter", 1000);
  // The name is empty because otherwise Ipopt would read a file ipopt.opt from the working directory.
  if (const auto status = application->Initialize(""); status != Ipopt::Solve_Succeeded) return report_of(status);
  return report_of(application->OptimizeTNLP(new StrandProblem(run.start, budgeted)));
}

}  // namespace softland::internal
