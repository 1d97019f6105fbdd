// The rounds of a tournament, with contenders that do nothing but count.
#include "studies/search/tournament.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace softland::tournament_test {
namespace {

constexpr std::array rounds{Round{.contenders = 4, .devices = 8, .closings = 10, .step = 0.3},
                            Round{.contenders = 2, .devices = 16, .closings = 20, .step = 0.2},
                            Round{.contenders = 1, .devices = 32, .closings = 40, .step = 0.1}};

// Each contender takes its closings at once, and the first ones go on. Returns the searches, as text.
std::vector<std::string> searches(SearchBudget& budget, double closings_over_those_of_the_table = 1, std::size_t last = 3) {
  std::vector<std::string> all;
  const Tournament<std::string> tournament{
      .budget = budget,
      .share = [&](const Round& round,
                   std::size_t) { return RoundShare{static_cast<long>(closings_over_those_of_the_table * round.closings)}; },
      .search =
          [&](const std::string& name, SearchInRound turn, const Chain& chain, SearchBudget& part) {
            EXPECT_EQ(chain.devices, rounds[turn.round].devices);
            EXPECT_EQ(chain.step, rounds[turn.round].step);
            EXPECT_GE(part.left(), chain.closings);
            part.took(chain.closings);
            all.push_back(std::to_string(turn.round) + std::to_string(turn.number) + name);
          },
      .select =
          [&](std::vector<std::string> names, std::size_t round) {
            names.resize(round < last ? rounds[std::min(round + 1, rounds.size() - 1)].contenders : 0);
            return names;
          }};
  tournament.run(rounds, {"a", "b", "c", "d"});
  return all;
}

TEST(Tournament, SearchesFromWhatGoesOnInEachRound) {
  SearchBudget budget({.evaluations = 1000});
  EXPECT_EQ(searches(budget), (std::vector<std::string>{"00a", "01b", "02c", "03d", "10a", "11b", "20a"}));
  EXPECT_EQ(budget.taken(), 4 * 10 + 2 * 20 + 40);
}

TEST(Tournament, EndsWhenNobodyGoesOn) {
  SearchBudget budget({});
  EXPECT_EQ(searches(budget, 1, 1).size(), 6U);
}

TEST(Tournament, EndsBeforeARoundWithoutClosings) {
  SearchBudget budget({});
  EXPECT_TRUE(searches(budget, 0.09).empty());
  EXPECT_EQ(budget.taken(), 0);
}

TEST(Tournament, EndsWithItsBudget) {
  SearchBudget budget({});
  budget.give_up();
  EXPECT_TRUE(searches(budget).empty());
}

}  // namespace
}  // namespace softland::tournament_test
