// A search with a memory ends with the same bits as without, and simulates no candidate twice.
#include "studies/search/evaluation_memory.h"

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "scenes.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_optimize.h"
#include "studies/search/search_setting.h"

namespace softland::evaluation_memory_test {
namespace {

class Memory : public EvaluationMemory {
 public:
  std::optional<EvaluationValues> recall(const EvaluationKey& key) noexcept override {
    const std::scoped_lock lock(mutex_);
    const auto found = known_.find(tied(key));
    return found == known_.end() ? std::nullopt : std::optional(found->second);
  }
  void note(const EvaluationKey& key, const EvaluationValues& values) noexcept override {
    const std::scoped_lock lock(mutex_);
    known_.emplace(tied(key), values);
    ++noted_;
  }
  [[nodiscard]] long noted() const { return noted_; }
  /// Forgets every other evaluation, as if the search had been killed.
  void forget_half() {
    bool keep = false;
    std::erase_if(known_, [&](const auto&) { return keep = !keep; });
  }
  void count_anew() { noted_ = 0; }

 private:
  using Key = std::tuple<std::size_t, std::vector<double>, std::uint64_t, std::uint64_t, double>;
  static Key tied(const EvaluationKey& key) { return {key.family, key.x, key.devices, key.seed, key.hopeless}; }
  std::mutex mutex_;
  std::map<Key, EvaluationValues> known_;
  long noted_ = 0;
};

SceneFile quick() {
  return gold({"simulate.duration=150 us", "structure.modes=2", "simulate.accuracy=1e-3", "waveform.main.level=18 V",
               "driver.main.max_voltage=40 V"});
}

struct Found {
  std::map<long, Evaluation> evaluations;
  std::optional<OptimizeResult> result;
};

void expect_same(const Found& a, const Found& b, const std::string& what) {
  ASSERT_EQ(a.evaluations.size(), b.evaluations.size()) << what;
  for (const auto& [index, e] : a.evaluations) {
    ASSERT_TRUE(b.evaluations.contains(index)) << what;
    EXPECT_EQ(e.x, b.evaluations.at(index).x) << what << " " << index;
    EXPECT_EQ(e.value, b.evaluations.at(index).value) << what << " " << index;
  }
  ASSERT_EQ(a.result->best_scene.has_value(), b.result->best_scene.has_value()) << what;
  const auto text = [](const Found& found) {
    return found.result->best_scene ? found.result->best_scene->scene.file.text() : std::string();
  };
  EXPECT_EQ(text(a), text(b)) << what;
}

Found searched(OptimizeOptions options, EvaluationMemory* memory) {
  Found found;
  options.memory = memory;
  options.on_evaluation = [&](const Evaluation& e, const OptimizeProgress&) { found.evaluations[e.index] = e; };
  found.result.emplace(optimize(with_keys_for(options.target.parts()[0].target, quick()), options));
  return found;
}

TEST(EvaluationMemory, LeavesEveryOptimizerTheSameBits_slow) {
  for (const std::string_view optimizer : optimizer_names()) {
    const OptimizeOptions options{.optimizer = std::string(optimizer), .max_evaluations = 90};
    const std::string name(optimizer);
    const Found without = searched(options, nullptr);
    Memory memory;
    expect_same(without, searched(options, &memory), name);
    EXPECT_GT(memory.noted(), 0) << name;
    memory.count_anew();
    expect_same(without, searched(options, &memory), name + ", all known");
    EXPECT_EQ(memory.noted(), 0) << name;
    memory.forget_half();
    expect_same(without, searched(options, &memory), name + ", half known");
    EXPECT_GT(memory.noted(), 0) << name;
  }
}

TEST(EvaluationMemory, LeavesEveryTargetTheSameBits_optimized) {
  for (const Target target : every_target) {
    const OptimizeOptions options{.target = target, .max_evaluations = 60};
    const Found without = searched(options, nullptr);
    Memory memory;
    (void)searched(options, &memory);
    memory.count_anew();
    expect_same(without, searched(options, &memory), std::string(to_string(target)));
    EXPECT_EQ(memory.noted(), 0) << to_string(target);
  }
}

TEST(EvaluationMemory, LeavesARobustSearchTheSameBits_optimized) {
  const auto searched_over_devices = [](EvaluationMemory* memory, std::uint64_t seed, int jobs) {
    Found found;
    OptimizeOptions options{.max_evaluations = 900, .seed = seed, .jobs = jobs, .memory = memory};
    options.on_evaluation = [&](const Evaluation& e, const OptimizeProgress&) { found.evaluations[e.index] = e; };
    const RobustAim aim{.measure = parse_robust_measure("cvar:0.9", device_figures), .conditions = {}};
    RobustResult result = robust_optimize(quick(), options, {.aim = aim, .samples = 40, .verdict = 8});
    found.result.emplace(std::move(result.found));
    return found;
  };
  const Found without = searched_over_devices(nullptr, 1, 2);
  Memory memory;
  (void)searched_over_devices(&memory, 1, 1);
  memory.count_anew();
  expect_same(without, searched_over_devices(&memory, 1, 2), "all known");
  EXPECT_EQ(memory.noted(), 0);
  memory.forget_half();
  expect_same(without, searched_over_devices(&memory, 1, 2), "half known");
  // Evaluations on other devices are not in the memory.
  memory.count_anew();
  expect_same(searched_over_devices(nullptr, 2, 2), searched_over_devices(&memory, 2, 2), "another seed");
  EXPECT_GT(memory.noted(), 0);
}

TEST(StartingWaveforms, AreCandidatesThatStayTheBestUntilABetterOneIsFound) {
  const Found long_search = searched({.max_evaluations = 400}, nullptr);
  OptimizeOptions options{.max_evaluations = 6};
  const Found short_search = searched(options, nullptr);
  options.starts = {{.name = "earlier", .waveforms = long_search.result->best_scene->drives.waveforms()}};
  const Found refined = searched(options, nullptr);
  EXPECT_LT(long_search.result->best_cost, short_search.result->best_cost);
  constexpr double rounding = 1e-6;  // rounding of the parameters in a written scene
  EXPECT_LE(refined.result->best_cost, long_search.result->best_cost * (1 + rounding));
  EXPECT_LE(refined.evaluations.begin()->second.value, long_search.result->best_cost * (1 + rounding))
      << "the search begins with them";
}

TEST(StartingWaveforms, ThatDoNotFitAreRefusedBeforeTheSearchBegins) {
  const auto refused = [](const Waveform& waveform, const char* family) {
    OptimizeOptions options{.family = family, .max_evaluations = 6};
    options.starts = {{.name = "earlier", .waveforms = {{"main", waveform}}}};
    options.on_start = [](const FamilyColumns&) { ADD_FAILURE() << "begun"; };
    return refusal([&] { (void)optimize(quick(), options); });
  };
  EXPECT_EQ(refused(Pulse{.levels = {20, 5, 17}, .times = {20e-6, 32e-6}, .edge = 1e-6}, "pulse"),
            "earlier: drive 'main' ends on 17 V, and the scene holds 18 V, which no search changes");
  EXPECT_EQ(refused(Pulse{.levels = {41, 5, 18}, .times = {20e-6, 32e-6}, .edge = 1e-6}, "pulse"),
            "earlier: drive 'main': the voltage reaches 41 V, above the driver's max_voltage of 40 V");
  EXPECT_EQ(refused(Step{.level = 17}, "staircase:3"),
            "earlier: drive 'main' ends on 17 V, and the scene holds 18 V, which no search changes");
  OptimizeOptions options{.starts = {{.name = "earlier", .waveforms = {{"far", Step{.level = 18}}}}}};
  EXPECT_EQ(refusal([&] { (void)optimize(quick(), options); }), "earlier: there is no waveform of the searched drive 'main'");
}

}  // namespace
}  // namespace softland::evaluation_memory_test
