// A search in two stages. Two thirds of the budget go by a guide cost, which finds the right valleys; the rest goes by the
// search's target cost, from the best points so far. Both stages are logged by the target cost, as one search. There is one
// stage if the two costs are the same.
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

/// Two costs of one point; infinite if it is infeasible.
struct SearchCosts {
  double guide = std::numeric_limits<double>::infinity();
  double target = std::numeric_limits<double>::infinity();
  bool lands = false;  ///< true for a closing without a significant rebound
  /// The same under conditions: costs without the penalty of broken ones, and each g of Conditions.
  struct Apart {
    double guide, target;
    std::vector<double> excess;
  };
  std::optional<Apart> apart = {};  ///< none without conditions, and if the prices are remembered from another search
};

/// Gradients of the two costs as Problem::gradient, or null; under conditions as Conditions::gradients.
struct CostGradients {
  std::function<std::vector<double>(std::span<const double>)> guide, target;
  std::size_t conditions = 0;
  /// The costs of a point, computed again whatever is remembered.
  std::function<SearchCosts::Apart(std::span<const double>)> apart = {};
};

/// The cost that a run minimises: the common one, the guide, the target, or the guide for two thirds of the budget and then
/// the target.
enum class Costs { same, guide, target, both };

/// Divisor of the budget: such a part of it goes to the target cost of a target that has one.
inline constexpr long target_share = 3;

class GuidedSearch {
 public:
  /// `price` is as Problem::objective; `on_evaluation` as OptimizerOptions::on_evaluation, with the target cost as value.
  GuidedSearch(std::function<SearchCosts(std::span<const double>)> price, std::function<void(const Evaluation&)> on_evaluation,
               CostGradients slopes = {})
      : price_(std::move(price)), on_evaluation_(std::move(on_evaluation)), slopes_(std::move(slopes)) {}

  /// Minimises over the variables of `problem` from its starts. Its objective and the callbacks of `options` are not used.
  /// Throws as minimize() does. Result, improvements and indices, from `first_index` on, are those of one search by the target
  /// cost. If both costs are the same and no point lands, a second stage of `more` evaluations goes on from the best points. A
  /// further run goes on from them too. It begins at starts that were not tried as well, and its result is that of all runs.
  [[nodiscard]] OptimizerResult run(Problem problem, OptimizerOptions options, Costs costs, long more = 0, long first_index = 0);
  struct Best {
    Evaluation evaluation;  ///< evaluation with the target cost as value
    double cost = 0;        ///< guide or target cost
  };
  /// Returns the evaluation with the lowest cost: by the guide for `Costs::guide`, by the target otherwise. Nothing if
  /// none is feasible.
  [[nodiscard]] std::optional<Best> best(Costs costs) const;
  /// Every evaluation, by index, with the target cost as value.
  [[nodiscard]] const std::map<long, Evaluation>& log() const { return log_; }
  /// Returns the point with the least guide cost, among those whose target cost is below `own` and that differ from the
  /// `others`.
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
  std::map<long, Evaluation> log_;  ///< evaluations by index
  long first_index_ = 0;            ///< index of the stage's first evaluation
};

}  // namespace softland
