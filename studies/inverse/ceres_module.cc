#include "studies/inverse/ceres_module.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

namespace softland {
namespace {

// Evaluates all residuals of a fit at x at once. Ceres requests the residuals one by one, so that each may have its own loss.
class Evaluations final : public ceres::EvaluationCallback {
 public:
  Evaluations(const LeastSquares& problem, const std::vector<double>& x, const Progress& progress)
      : problem_(problem),
        x_(x),
        progress_(progress),
        residuals_(problem.residuals),
        jacobian_(problem.residuals * problem.unknowns) {}

  void PrepareForEvaluation(bool with_jacobian, bool is_new) final {
    if (fault || (!is_new && (has_jacobian_ || !with_jacobian))) return;
    try {
      progress_.throw_if_stopped();
      ++evaluations;
      if (with_jacobian) ++jacobians;
      is_known_ = problem_.evaluate(x_, residuals_, with_jacobian ? jacobian_.data() : nullptr);
    } catch (...) {  // exceptions must not pass through Ceres
      fault = std::current_exception();
      is_known_ = false;
    }
    has_jacobian_ = with_jacobian && is_known_;
    const auto is_finite = [](double v) { return std::isfinite(v); };
    is_known_ =
        is_known_ && std::ranges::all_of(residuals_, is_finite) && (!with_jacobian || std::ranges::all_of(jacobian_, is_finite));
  }
  [[nodiscard]] bool are_known() const { return is_known_; }
  [[nodiscard]] double residual(std::size_t i) const { return residuals_[i]; }
  [[nodiscard]] const double* row(std::size_t i) const { return jacobian_.data() + i * problem_.unknowns; }

  long evaluations = 0, jacobians = 0;
  std::exception_ptr fault;

 private:
  const LeastSquares& problem_;
  const std::vector<double>& x_;
  const Progress& progress_;
  std::vector<double> residuals_, jacobian_;
  bool is_known_ = false, has_jacobian_ = false;
};

class OneResidual final : public ceres::CostFunction {
 public:
  OneResidual(const Evaluations& all, std::size_t number, std::size_t unknowns)
      : all_(all), number_(number), unknowns_(unknowns) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns));
  }
  bool Evaluate(double const* const*, double* residuals, double** jacobians) const final {
    if (!all_.are_known()) return false;
    residuals[0] = all_.residual(number_);
    if (jacobians != nullptr && jacobians[0] != nullptr) std::copy_n(all_.row(number_), unknowns_, jacobians[0]);
    return true;
  }

 private:
  const Evaluations& all_;
  std::size_t number_, unknowns_;
};

std::unique_ptr<ceres::LossFunction> loss_function(Loss loss) {
  switch (loss) {
    case Loss::huber:
      return std::make_unique<ceres::HuberLoss>(loss_scale);
    case Loss::cauchy:
      return std::make_unique<ceres::CauchyLoss>(loss_scale);
    case Loss::none:
      break;
  }
  return nullptr;
}

// Silences the log of Ceres; the summary that Ceres returns has the same content.
void silence_log() {
  static std::once_flag once;
  std::call_once(once, [] { FLAGS_minloglevel = google::GLOG_FATAL; });
}

void solve_by_ceres(const LeastSquares& problem, std::vector<double> start, const Progress& progress, LeastSquaresEnd& end,
                    std::exception_ptr& fault) {
  silence_log();
  std::vector<double> x = std::move(start);
  Evaluations all(problem, x, progress);
  const std::unique_ptr<ceres::LossFunction> loss = loss_function(problem.loss);
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.evaluation_callback = &all;
  ceres::Problem ceres_problem(ownership);
  for (std::size_t i = 0; i < problem.residuals; ++i)
    ceres_problem.AddResidualBlock(new OneResidual(all, i, problem.unknowns), i < problem.robust ? loss.get() : nullptr,
                                   x.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 60;
  options.function_tolerance = 1e-10;
  options.parameter_tolerance = 1e-9;
  options.gradient_tolerance = 1e-9;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  fault = all.fault;
  end = {.evaluations = all.evaluations, .with_jacobian = all.jacobians, .message = summary.message};
  if (fault || summary.termination_type == ceres::FAILURE) return;
  end.converged = summary.termination_type == ceres::CONVERGENCE;
  end.cost = summary.final_cost;
  end.x = std::move(x);
}

}  // namespace
}  // namespace softland

extern "C" void softland_ceres_solve(const softland::LeastSquares& problem, std::vector<double> start,
                                     const softland::Progress& progress, softland::LeastSquaresEnd& end,
                                     std::exception_ptr& fault) {
  softland::solve_by_ceres(problem, std::move(start), progress, end, fault);
}
