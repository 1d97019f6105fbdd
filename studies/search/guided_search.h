// A search in two stages. The first stage spends two thirds of the budget on minimising a guide cost, that of bounce, which
// leads to bounce-free closings. The second stage minimises the target cost, from the best points of the first stage. The log
// shows both stages as one search by the target cost. There is only one stage if both costs are the same.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "optimizers/problem.h"

namespace softland {

/// The guide cost and the target cost of one point; infinite if the point is infeasible.
struct SearchCosts {
  double guide = std::numeric_limits<double>::infinity();
  double target = std::numeric_limits<double>::infinity();
  bool bounce_free = false;  ///< true if the switch closes without a significant rebound
  /// Costs of a point without the penalty for violated conditions, and the excess g of each condition, which is fulfilled if g
  /// <= 0. Optimizers with constraints use these values.
  struct Apart {
    double guide, target;
    std::vector<double> excess;
  };
  /// Costs without the penalty for conditions; empty without conditions, and if the costs come from an EvaluationMemory.
  std::optional<Apart> apart = {};
};

/// Functions that compute the gradients of the guide cost and of the target cost, as Problem::gradient; may be null. If the
/// search has conditions, the functions also return the gradients of the conditions, as Conditions::gradients.
struct CostGradients {
  std::function<std::vector<double>(std::span<const double>)> guide, target;
  std::size_t conditions = 0;
  /// Computes the costs of a point without the penalty for conditions, by a new simulation.
  std::function<SearchCosts::Apart(std::span<const double>)> apart = {};
};

/// The cost that a run of the search minimises. `same`: guide cost and target cost are the same; `both`: the guide cost for two
/// thirds of the budget, then the target cost.
enum class Costs { same, guide, target, both };

/// A third (1 / target_share) of the budget is spent on the target cost, if it differs from the guide cost.
inline constexpr long target_share = 3;

class GuidedSearch {
 public:
  /// `price` computes the costs of a point, as Problem::objective does; `on_evaluation` is as OptimizerOptions::on_evaluation,
  /// with the target cost as value.
  GuidedSearch(std::function<SearchCosts(std::span<const double>)> price, std::function<void(const Evaluation&)> on_evaluation,
               CostGradients slopes = {})
      : price_(std::move(price)), on_evaluation_(std::move(on_evaluation)), slopes_(std::move(slopes)) {}

  /// Minimises over the variables of `problem` from its starts. The objective of `problem` and the callbacks of `options` are
  /// not used. Throws the exceptions of minimize(). Result, improvements and indices are those of one search by the target
  /// cost; the first index is `first_index`. If both costs are the same and no point closes without a bounce, a second stage of
  /// `more` evaluations continues from the best points. A further call of run() begins at the best points of earlier calls and
  /// at new starts; its result covers all calls.
  [[nodiscard]] OptimizerResult run(Problem problem, OptimizerOptions options, Costs costs, long more = 0, long first_index = 0);
  struct Best {
    Evaluation evaluation;  ///< best evaluation, with the target cost as value
    double cost = 0;        ///< guide cost or target cost of the evaluation, as requested
  };
  /// Returns the evaluation with the lowest guide cost for `Costs::guide`, with the lowest target cost otherwise. Empty if no
  /// evaluation is feasible.
  [[nodiscard]] std::optional<Best> best(Costs costs) const;
  /// Returns all evaluations of the search, by index, with the target cost as value.
  [[nodiscard]] const std::map<long, Evaluation>& log() const { return log_; }
  /// Returns the evaluation that most reliably closes without a bounce: the one with the least guide cost, among evaluations
  /// whose target cost is below `own` and whose points are not among `others`.
  [[nodiscard]] std::optional<Evaluation> surest_below(double own, const std::vector<std::vector<double>>& others) const;

 private:
  [[nodiscard]] OptimizerResult stage(Problem problem, OptimizerOptions options, bool guide);
  [[nodiscard]] std::vector<double> values_apart(std::span<const double> x, bool guide);
  [[nodiscard]] std::vector<std::vector<double>> promising_points(const std::vector<Variable>& variables, Costs costs) const;
  [[nodiscard]] double cost_of(const Evaluation& e, Costs costs) const;

  std::function<SearchCosts(std::span<const double>)> price_;
  std::function<void(const Evaluation&)> on_evaluation_;
  CostGradients slopes_;
  std::mutex mutex_;
  std::map<std::vector<double>, SearchCosts> known_;
  std::map<long, Evaluation> log_;  ///< evaluations of the search by index
  long first_index_ = 0;            ///< index of the first evaluation in the current stage of the search
};

}  // namespace softland
