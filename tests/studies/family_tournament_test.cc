// The comparison of families over devices, on a beam with two modes and with few devices.
#include "studies/search/family_tournament.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <initializer_list>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/studies/scenes.h"

namespace softland {
namespace {

class FamilyTournament : public testing::Test {
 protected:
  explicit FamilyTournament(const SceneFile& file = gold({"simulate.duration=150 us", "structure.modes=2",
                                                          "waveform.main.level=18 V", "driver.main.max_voltage=25 V"}))
      : settings_(search_settings(file, Target::bounce, Actuator::electrostatic, "pulse+catch", {})),
        cost_(settings_.front(), aims_.tail, own_devices(settings_.front(), MeasuredUnits(), 32, 5, 0, 1, {})) {}

  TournamentResult run(TournamentOptions options, BudgetLimits limits = {}) {
    options.closings = tournament_closings / 4;
    SearchBudget budget(std::move(limits));
    TournamentResult found = family_tournament(settings_, cost_, aims_, budget, options);
    EXPECT_EQ(budget.taken(), found.closings);
    return found;
  }
  [[nodiscard]] double cost_of(const Contender& contender) const {
    const SearchSetting& setting = settings_[contender.family];
    return cost_.value(cost_.close(setting.drives(contender.waveforms), 0, 32, 1), aims_.tail);
  }

  TournamentAims aims_{.tail = {.measure = parse_robust_measure("cvar:0.9", device_figures), .conditions = {}},
                       .share = {.measure = parse_robust_measure("yield", device_figures), .conditions = {}}};
  std::vector<SearchSetting> settings_;
  RobustCost cost_;
};

// Remembers the evaluations that it is given, by the text of their key.
class Remembered final : public EvaluationMemory {
 public:
  std::optional<EvaluationValues> recall(const EvaluationKey& key) noexcept override {
    const std::scoped_lock lock(mutex_);
    const auto found = known_.find(text(key));
    if (found == known_.end()) return std::nullopt;
    ++recalled;
    return found->second;
  }
  void note(const EvaluationKey& key, const EvaluationValues& values) noexcept override {
    const std::scoped_lock lock(mutex_);
    sizes[key.family] = key.x.size();
    ++noted;
    known_.emplace(text(key), values);
  }
  std::size_t recalled = 0, noted = 0;
  std::map<std::size_t, std::size_t> sizes;  // number of parameters of the points of each family

 private:
  static std::string text(const EvaluationKey& key) {
    std::string all = std::to_string(key.family) + " " + std::to_string(key.devices) + " " + std::to_string(key.seed) + " " +
                      std::to_string(key.hopeless);
    for (const double x : key.x) all.append(reinterpret_cast<const char*>(&x), sizeof x);
    return all;
  }
  std::mutex mutex_;
  std::map<std::string, EvaluationValues> known_;
};

TEST_F(FamilyTournament, EndsWithTheSameBitsWhateverTheJobsAndTheMemory_optimized) {
  const TournamentResult one = run({.seed = 3});
  ASSERT_FALSE(one.contenders.empty());
  Remembered memory;
  const TournamentResult two = run({.seed = 3, .jobs = 2, .memory = &memory});
  EXPECT_GT(memory.noted, 100U);
  EXPECT_EQ(memory.sizes, (std::map<std::size_t, std::size_t>{{0, settings_[0].space.variables().size()},
                                                              {1, settings_[1].space.variables().size()}}));
  const std::size_t noted = memory.noted;
  const TournamentResult again = run({.seed = 3, .jobs = 2, .memory = &memory});
  EXPECT_EQ(memory.noted, noted) << "all is known";
  for (const TournamentResult* other : {&two, &again}) {
    ASSERT_EQ(other->contenders.size(), one.contenders.size());
    EXPECT_EQ(other->closings, one.closings);
    for (std::size_t i = 0; i < one.contenders.size(); ++i) {
      EXPECT_EQ(other->contenders[i].x, one.contenders[i].x) << i;
      EXPECT_EQ(other->contenders[i].measure, one.contenders[i].measure) << i;
    }
  }
  EXPECT_NE(run({.seed = 4}).contenders.front().x, one.contenders.front().x);
}

TEST_F(FamilyTournament, EndsBetterThanItBegins_optimized) {
  const TournamentResult found = run({.seed = 1, .jobs = 2});
  double least = std::numeric_limits<double>::infinity(), of_starts = least;
  for (const Contender& contender : found.contenders) least = std::min(least, cost_of(contender));
  for (const SearchSetting& setting : settings_) {
    for (const std::vector<double>& x : setting.space.starts())
      of_starts = std::min(of_starts, cost_.value(cost_.close(setting.drives(setting.space.waveforms(x)), 0, 32, 1), aims_.tail));
  }
  EXPECT_LT(least, 0.8 * of_starts);
  EXPECT_LT(least, 0.8 * cost_.value(cost_.close(settings_[0].drives({}), 0, 32, 1), aims_.tail)) << "than the plain step";
  EXPECT_NEAR(static_cast<double>(found.closings), tournament_closings / 4.0, tournament_closings / 8.0)
      << "two families of five";
}

TEST_F(FamilyTournament, EndsWhenItIsAskedTo) {
  std::atomic<bool> stop = true;
  EXPECT_TRUE(run({}, {.stop = &stop}).contenders.empty());
  EXPECT_TRUE(run({}, {.seconds = 0}).contenders.empty());
}

TEST_F(FamilyTournament, WithTooFewClosingsIsNotRun) {
  SearchBudget budget({});
  const TournamentResult none = family_tournament(settings_, cost_, aims_, budget, {.closings = 1000});
  EXPECT_TRUE(none.contenders.empty());
  EXPECT_EQ(none.closings, 0);
}

// A switch with gaps of nanometres. Half of its devices land bounce-free, and more of them if they vary less.
class RaceOfNearlyEqualDevices : public FamilyTournament {
 protected:
  RaceOfNearlyEqualDevices()
      : FamilyTournament(scene("nem-tin.toml", {"spread.\"structure.thickness\".cov=0.2 %",
                                                "spread.\"structure.youngs_modulus\".cov=0.2 %", "spread.gaps.cov=0.2 %"})) {}
};

TEST_F(RaceOfNearlyEqualDevices, TakesLongerUnlessItsClosingsAreABudget_optimized) {
  std::mutex guard;
  std::vector<double> parts;
  const auto note = [&](double part) {
    const std::scoped_lock lock(guard);
    parts.push_back(part);
  };
  const TournamentResult longer = run({.seed = 1, .jobs = 2, .progress = note}),
                         shorter = run({.are_a_budget = true, .seed = 1, .jobs = 2});
  EXPECT_GT(static_cast<double>(longer.closings), 1.3 * static_cast<double>(shorter.closings));
  EXPECT_GT(longer.contenders.front().bounce_free, 0.5);
  EXPECT_LT(parts[parts.size() * 8 / 10], 0.999) << "what is to come is known";
}

}  // namespace
}  // namespace softland
