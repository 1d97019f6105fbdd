// A search in two stages: two thirds of the budget by a leading cost, which finds the right valleys, then the rest by the
// search's own cost, from the best points so far. Both stages are logged by the own cost, as one search. Where the two costs are
// the same there is one stage.
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

/// Two costs of one point; infinite where it is infeasible.
struct SearchCosts {
  double leading = std::numeric_limits<double>::infinity();
  double own = std::numeric_limits<double>::infinity();
  bool lands = false;  ///< without a significant rebound
  /// The same under conditions: costs without what broken ones add, and each g of Conditions.
  struct Apart {
    double leading, own;
    std::vector<double> excess;
  };
  std::optional<Apart> apart = {};  ///< none without conditions, and where the prices are remembered from another search
};

/// Gradients of the two costs as Problem::gradient, null where there is none; under conditions as Conditions::gradients.
struct PriceSlopes {
  std::function<std::vector<double>(std::span<const double>)> leading, own;
  std::size_t conditions = 0;
  /// Of a point, whatever is remembered.
  std::function<SearchCosts::Apart(std::span<const double>)> apart = {};
};

/// What a run minimises: the two costs are the same, the leading one, the own one, or two thirds of the budget the leading one
/// and then the own.
enum class Costs { same, leading, own, both };

/// The budget of a target with a cost of its own is divided by this: so much of it goes to that cost.
inline constexpr long own_share = 3;

class GuidedSearch {
 public:
  /// `price` as Problem::objective; `on_evaluation` as OptimizerOptions::on_evaluation, with the own cost as value.
  GuidedSearch(std::function<SearchCosts(std::span<const double>)> price, std::function<void(const Evaluation&)> on_evaluation,
               PriceSlopes slopes = {})
      : price_(std::move(price)), on_evaluation_(std::move(on_evaluation)), slopes_(std::move(slopes)) {}

  /// Minimises over the variables of `problem` from its starts; its objective is not used, nor are the callbacks of `options`.
  /// Throws as minimize() does. Result, improvements and indices, from `first_index` on, are those of one search by the own cost.
  /// Where both costs are the same and no point lands, a second stage of `more` evaluations goes on from the best points. So does
  /// a further run, which begins at starts that were not tried as well, and whose result is that of all.
  [[nodiscard]] OptimizerResult run(Problem problem, OptimizerOptions options, Costs costs, long more = 0, long first_index = 0);
  struct Best {
    Evaluation evaluation;  ///< with the own cost as value
    double cost = 0;        ///< the leading or the own one
  };
  /// Of every evaluation that of the least cost, the own or, for Costs::leading, the leading one. Nothing where none is feasible.
  [[nodiscard]] std::optional<Best> best(Costs costs) const;
  /// Every evaluation, by index, with the own cost as value.
  [[nodiscard]] const std::map<long, Evaluation>& log() const { return log_; }
  /// Of the points whose own cost is below `own`, and that differ from the `others`, the one of the least leading cost.
  [[nodiscard]] std::optional<Evaluation> surest_below(double own, const std::vector<std::vector<double>>& others) const;

 private:
  [[nodiscard]] OptimizerResult stage(Problem problem, OptimizerOptions options, bool leading);
  [[nodiscard]] std::vector<double> values_apart(std::span<const double> x, bool leading);
  [[nodiscard]] std::vector<std::vector<double>> promising_points(const std::vector<Variable>& variables, Costs costs) const;
  [[nodiscard]] double cost_of(const Evaluation& e, Costs costs) const;

  std::function<SearchCosts(std::span<const double>)> price_;
  std::function<void(const Evaluation&)> on_evaluation_;
  PriceSlopes slopes_;
  std::mutex mutex_;
  std::map<std::vector<double>, SearchCosts> known_;
  std::map<long, Evaluation> log_;  ///< by index
  long first_index_ = 0;            ///< of the stage
};

}  // namespace softland
