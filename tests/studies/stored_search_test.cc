// Stored searches of a library user: continued, refused, and from several seeds.
#include "studies/search/stored_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/require.h"
#include "store/study_store.h"
#include "studies/search/evaluation_store.h"
#include "studies/search/robust_optimize.h"
#include "studies/search/search_request.h"
#include "studies/search/seed_study.h"
#include "tests/studies/scenes.h"
#include "tests/support/temporary_folder.h"

namespace softland::stored_search_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class StoredSearches : public testing::Test {
 protected:
  static SceneFile quick() {
    return gold({"simulate.duration=150 us", "structure.modes=2", "simulate.accuracy=1e-3", "waveform.main.level=18 V",
                 "driver.main.max_voltage=40 V"});
  }
  static AskedSearch asked(const std::string& budget, const SceneFile& scene = quick()) {
    return {.request = {.waveform = "pulse", .robust = std::string(nominal_alone), .budget = budget},
            .given = GivenText{.file = "gold.toml", .folder = ".", .text = scene.text()},
            .scene = scene};
  }
  [[nodiscard]] fs::path file() const { return folder_.path() / evaluations_file; }

  // Returns the found scene, with the evaluations in the store; `computed` is the number of simulated ones.
  std::string found(const AskedSearch& asked, std::int64_t& computed) {
    std::optional<KnownSearch> known;
    StoredSearch search = stored_search(asked, fs::exists(file()) ? std::vector{file()} : std::vector<fs::path>(), known);
    EXPECT_EQ(known.has_value(), fs::exists(file()));
    std::optional<EvaluationStore> store;
    search.options.on_start = [&](const FamilyColumns& columns) {
      store.emplace(file(), search.plan, evaluations_at_most(search), search.options.seed, columns, StoredOrigin{});
      search.options.memory = &*store;
    };
    const FoundSearch found = run(search);
    computed = store->computed();
    store->close();
    return found.best().best_scene->scene.file.text();
  }

  test::TemporaryFolder folder_;
};

TEST_F(StoredSearches, GoOnWithoutSimulatingAnythingTwice) {
  std::int64_t first = 0, rest = 0, none = 0;
  static_cast<void>(found(asked("60"), first));
  const std::string whole = found(asked("150"), rest);
  EXPECT_GT(first, 30);
  EXPECT_GT(rest, 0);
  EXPECT_EQ(found(asked("150"), none), whole);
  EXPECT_EQ(none, 0);
  StoredSearch fresh = stored_search(asked("150"));
  EXPECT_EQ(run(fresh).best().best_scene->scene.file.text(), whole);
}

TEST_F(StoredSearches, HaveTheRequestAndTheSceneOfTheContinuedSearch) {
  std::int64_t first = 0;
  static_cast<void>(found(asked("60"), first));
  std::optional<KnownSearch> known;
  const StoredSearch search = stored_search({.request = {.budget = "70"}}, {file()}, known);
  ASSERT_TRUE(known);
  EXPECT_EQ(search.options.family, "pulse");
  EXPECT_EQ(search.options.max_evaluations, 70);
  EXPECT_EQ(search.scene.text(), quick().text());
}

TEST_F(StoredSearches, NameTheirDifferences) {
  std::int64_t first = 0;
  static_cast<void>(found(asked("40"), first));
  const auto refusal = [&](const AskedSearch& other) {
    std::optional<KnownSearch> known;
    try {
      static_cast<void>(stored_search(other, {file()}, known));
    } catch (const InvalidRequest& error) {
      return error.with_fields("--");
    }
    return std::string("taken");
  };
  AskedSearch impact = asked("40");
  impact.request.target = "impact";
  EXPECT_THAT(refusal(impact), HasSubstr("--resume: "));
  EXPECT_THAT(refusal(impact), HasSubstr("holds another search: it is for --target bounce, not impact"));
  SceneFile longer = quick();
  longer.set("simulate.duration=160 us");
  EXPECT_THAT(refusal(asked("40", longer)), HasSubstr("its scene has simulate.duration = \"0.00015 s\", not \"0.00016 s\""));
  AskedSearch begun = asked("40");
  begun.starts = {{.name = "other.toml", .scene = quick()}};
  EXPECT_THAT(refusal(begun), HasSubstr("it began with --start none, not other.toml"));
  EXPECT_EQ(refusal(asked("50")), "taken");
}

// Evaluations that former versions stored are not simulated again.
TEST_F(StoredSearches, KnowAPointOfAFamilyByTheValuesOfAllColumns) {
  const FamilyColumns columns{
      .families = {{"pulse.main.level_1_V", "pulse.main.time_1_s"}, {"step.main.level_V"}, {"a.x", "a.y"}}};
  EXPECT_THAT(columns.names(),
              testing::ElementsAre("pulse.main.level_1_V", "pulse.main.time_1_s", "step.main.level_V", "a.x", "a.y"));
  EXPECT_THAT(columns.row(1, std::array{2.0}),
              testing::ElementsAre(testing::IsNan(), testing::IsNan(), 2, testing::IsNan(), testing::IsNan()));
  {
    EvaluationStore store(file(), {{"a", 1}}, 10, 1, columns, {});
    store.note({.family = 1, .x = {2}}, {.cost = 0.5, .guide = 0.25});
    store.note({.family = 0, .x = {2, 3}}, {.cost = 0.75, .guide = 0.25});
    EXPECT_EQ(store.recall({.family = 1, .x = {2}})->cost, 0.5);
    EXPECT_FALSE(store.recall({.family = 1, .x = {3}}));
    EXPECT_FALSE(store.recall({.family = 0, .x = {2}}));
    EXPECT_EQ(refusal([&] { store.check(); }), "a point of 1 parameters is none of family 0");
    EXPECT_THROW((void)columns.row(3, std::array{2.0}), InvalidInput);
  }
  {
    EvaluationStore store(file(), {{"a", 1}}, 10, 1, columns, {});
    store.close();
  }
  std::vector<StoredRow> rows;
  StudyReader(file()).read([&](const StoredRow& row) { rows.push_back(row); });
  ASSERT_EQ(rows.size(), 2);
  EXPECT_EQ(
      rows[0].content,
      content_key("0 0 7ff0000000000000 7ff8000000000000 7ff8000000000000 4000000000000000 7ff8000000000000 7ff8000000000000"));
  EXPECT_EQ(
      rows[1].content,
      content_key("0 0 7ff0000000000000 4000000000000000 4008000000000000 7ff8000000000000 7ff8000000000000 7ff8000000000000"));
}

TEST_F(StoredSearches, OfSeveralSeedsAreRowsThatAreNotComputedAgain) {
  AskedSearch several = asked("60");
  several.request.seeds = "3";
  several.jobs = 2;
  const StoredSearch search = stored_search(several);
  const FamilyColumns columns = searched_parameters(search.scene, search.options, false, {}).columns;
  const auto study = [&](std::atomic<bool>* stop) {
    StoredSearch own = search;
    own.options.stop = stop;
    EvaluationStore evaluations(file(), own.plan, evaluations_at_most(own), own.options.seed, columns, {});
    SeedStudy seeds(own, evaluations, folder_.path() / "seeds.sqlite", columns.names(), {});
    int improved = 0;
    seeds.run({.improvement = [&](const SceneFile&) { ++improved; }});
    const std::vector<SearchOfSeed> all = seeds.searches();
    EXPECT_EQ(all.size() + seeds.missing(), 3);
    seeds.close();
    evaluations.close();
    return std::pair(all, improved);
  };
  std::atomic<bool> stop = true;
  EXPECT_TRUE(study(&stop).first.empty());
  const auto [all, improved] = study(nullptr);
  ASSERT_EQ(all.size(), 3);
  EXPECT_GT(improved, 0);
  EXPECT_EQ(all[1].seed, all[0].seed + 1);
  EXPECT_GT(all[1].evaluations, 30);
  const auto [again, improved_again] = study(nullptr);
  EXPECT_EQ(improved_again, 0) << "all of them are there";
  EXPECT_EQ(again[2].cost, all[2].cost);
  StoredSearch alone = stored_search(asked("60"));
  alone.options.seed = all[1].seed;
  EXPECT_EQ(optimize(alone.scene, alone.options).best_cost, all[1].cost);
}

}  // namespace
}  // namespace softland::stored_search_test
