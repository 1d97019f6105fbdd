// The log of a search: what it keeps, and what it reports while the search runs.
#include "studies/search/evaluation_log.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "tests/studies/scenes.h"

namespace softland::evaluation_log_test {
namespace {

constexpr double infeasible = std::numeric_limits<double>::infinity();

std::vector<long> indices(const std::vector<Evaluation>& all) {
  std::vector<long> found;
  for (const Evaluation& e : all) found.push_back(e.index);
  return found;
}

class LogOfASearch : public testing::Test {
 protected:
  LogOfASearch() {
    options_.on_evaluation = [this](const Evaluation& e, const OptimizeProgress& now) {
      reported_.push_back(e);
      best_ = now.best_cost;
      EXPECT_EQ(now.evaluations, budget_.taken());
      EXPECT_EQ(now.baseline_cost, 2);
    };
    options_.on_improvement = [this](const Evaluation& e, const SceneFile&) { improving_.push_back(e); };
    options_.on_progress = [this](const OptimizeProgress& now) { told_.push_back(now.evaluations); };
  }
  void note(long index, double value, std::size_t problem = 0) {
    budget_.took(1);
    log_.note({.index = index, .value = value, .x = {}, .problem = problem});
  }

  OptimizeOptions options_;
  SearchBudget budget_{{.evaluations = 100}};
  std::vector<Evaluation> reported_, improving_;
  std::vector<long> told_;
  double best_ = 0;
  SceneFile scene_ = scene("mem-gold.toml");
  EvaluationLog log_{options_, budget_, 2,
                     [this](const Evaluation& e) { return e.value < 5 ? std::optional(scene_) : std::nullopt; }};
};

TEST_F(LogOfASearch, FindsTheImprovementsInTheOrderOfTheIndex) {
  for (const auto& [index, value] : std::vector<std::pair<long, double>>{{3, 4}, {9, 1}, {0, infeasible}, {5, 4}, {1, 6}, {4, 3}})
    note(index, value);
  EXPECT_EQ(indices(improvements_of(log_.evaluations())), (std::vector<long>{1, 3, 4, 9}));
  EXPECT_EQ(log_.next_index(), 10);
  EXPECT_EQ(indices(reported_), (std::vector<long>{3, 9, 0, 5, 1, 4})) << "as they are made";
  EXPECT_EQ(indices(improving_), (std::vector<long>{3, 9})) << "better than all before in time";
  EXPECT_EQ(best_, 1);
}

TEST_F(LogOfASearch, ReportsNoImprovementThatHasNoScene) {
  note(0, 6);
  EXPECT_TRUE(improving_.empty());
  EXPECT_EQ(best_, 6);
}

TEST_F(LogOfASearch, KeepsTheEvaluationsOfEachProblemApart) {
  note(0, 3, 1);
  note(1, 2, 0);
  note(2, 1, 1);
  EXPECT_EQ(log_.evaluations(1).size(), 2U);
  EXPECT_EQ(log_.evaluations(0).begin()->first, 1);
  EXPECT_TRUE(log_.evaluations(2).empty());
}

TEST_F(LogOfASearch, DoesNotKeepWhatTheSearchBeginsWith) {
  log_.begin_with({.index = given_index, .value = 3, .x = {}}, scene_);
  log_.begin_with({.index = given_index, .value = 4, .x = {}}, scene_);
  note(0, 3.5);
  EXPECT_EQ(indices(improving_), (std::vector<long>{given_index}));
  EXPECT_EQ(best_, 3);
  EXPECT_EQ(log_.evaluations().size(), 1U);
}

TEST_F(LogOfASearch, TellsTheCountOfTheBudget) {
  log_.tell();
  budget_.took(7);
  log_.tell();
  EXPECT_EQ(told_, (std::vector<long>{0, 7}));
  EXPECT_TRUE(log_.evaluations().empty());
}

}  // namespace
}  // namespace softland::evaluation_log_test
