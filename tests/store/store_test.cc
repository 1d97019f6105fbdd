// Tests that a store returns what was written, whoever continues it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <thread>

#include "base/require.h"
#include "store/study_store.h"
#include "tests/store/sample.h"

namespace softland::test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Opening = StudyStore::Opening;

using Store = WithStore;

TEST_F(Store, GivesBackEveryBitOfItsRows) {
  std::vector<StoredRow> rows;
  for (int point = 0; point < 2500; ++point) rows.push_back(row_of(point));
  rows[3].values = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 5e-324, 0.1};
  rows[4].values = {1.7976931348623157e308, 9007199254740993.0, -1.0, 1e22};
  rows[5].reason = "Zeilen\n, \"Anführung\" und \x01";
  StudyStore store(file, plan_of(2500), origin(), Opening::fresh);
  for (const StoredRow& row : rows) store.add(row);
  store.close();
  EXPECT_EQ(dump(file), dump(rows));
}

TEST_F(Store, LeavesOneFileWhenItIsClosed) {
  make_store(file, 100);
  EXPECT_THAT(names_in(file.parent_path()), ::testing::ElementsAre("study.sqlite"));
  static_cast<void>(rows_in(file));
  EXPECT_THAT(names_in(file.parent_path()), ::testing::ElementsAre("study.sqlite"));
}

// The system's files with a clock after the year 9999, for which SQLite has no date.
class FarClock {
 public:
  FarClock() : usual_(sqlite3_vfs_find(nullptr)), files_(*usual_) {
    files_.zName = "far clock";
    files_.xCurrentTimeInt64 = [](sqlite3_vfs*, sqlite3_int64* now) {
      constexpr sqlite3_int64 day = 86'400'000, of_the_year_10346 = 5'500'000;  // [ms], Julian
      *now = of_the_year_10346 * day;
      return SQLITE_OK;
    };
    sqlite3_vfs_register(&files_, 1);
  }
  FarClock(const FarClock&) = delete;
  FarClock& operator=(const FarClock&) = delete;
  ~FarClock() {
    sqlite3_vfs_unregister(&files_);
    sqlite3_vfs_register(usual_, 1);
  }

 private:
  sqlite3_vfs* usual_;
  sqlite3_vfs files_;
};

TEST_F(Store, IsWrittenReadAndGoneOnWithAfterTheYear9999) {
  {
    const FarClock clock;
    StudyStore store(file, plan_of(100), origin(), Opening::fresh);
    for (std::int64_t point = 0; point < 60; ++point) store.add(row_of(point));
    store.close();
  }
  const FarClock clock;
  StudyStore more(file, plan_of(100), origin(), Opening::resume);
  for (std::int64_t point = 60; point < 100; ++point) more.add(row_of(point));
  more.close();
  make_store(path("now.sqlite"), 100);
  EXPECT_EQ(dump(file), dump(path("now.sqlite")));
  const std::vector<StoredSession> sessions = StudyReader(file).sessions();
  ASSERT_EQ(sessions.size(), 2U);
  for (const StoredSession& one : sessions) {
    EXPECT_EQ(one.began, "after the year 9999");
    EXPECT_EQ(one.last, "after the year 9999");
    EXPECT_FALSE(one.seconds > 0) << "nobody knows how long it took";
  }
}

TEST_F(Store, KeepsThePlanAndWhoComputed) {
  make_store(file, 9, {.index = 2, .count = 3});
  const StudyReader reader(file);
  const StoredPlan expected = plan_of(9, {.index = 2, .count = 3});
  EXPECT_EQ(reader.plan().text, expected.text);
  EXPECT_EQ(reader.plan().points, expected.points);
  EXPECT_EQ(reader.plan().columns, expected.columns);
  EXPECT_EQ(reader.plan().seed, expected.seed);
  EXPECT_EQ(reader.plan().shard, expected.shard);
  ASSERT_EQ(reader.sessions().size(), 1u);
  EXPECT_EQ(reader.sessions()[0].program, origin().program);
  EXPECT_EQ(reader.sessions()[0].processor, origin().processor);
  EXPECT_EQ(reader.sessions()[0].command, origin().command);
  EXPECT_EQ(reader.sessions()[0].process, ::getpid());
  EXPECT_EQ(reader.sessions()[0].rows, 3);
}

TEST_F(Store, CountsItsRowsByStatus) {
  make_store(file, 1000);
  std::map<std::string, std::int64_t> counted;
  for (const StoredRow& row : rows_in(file)) ++counted[row.status];
  EXPECT_EQ(StudyReader(file).by_status(), counted);
  EXPECT_EQ(counted.size(), 2u);
}

TEST_F(Store, GoesOnWhereItWasLeft) {
  {
    StudyStore store(file, plan_of(10), origin(), Opening::resume);  // there is no store yet
    for (const std::int64_t point : {0, 3, 4}) store.add(row_of(point));
  }
  StudyStore store(file, plan_of(10), origin(), Opening::resume);
  const std::vector<bool> done = store.done();
  for (int point = 0; point < 10; ++point)
    EXPECT_EQ(done[static_cast<std::size_t>(point)], point == 0 || point == 3 || point == 4) << point;
  for (int point = 0; point < 10; ++point) {
    if (!done[static_cast<std::size_t>(point)]) store.add(row_of(point));
  }
  store.close();
  make_store(path("at-once.sqlite"), 10);
  EXPECT_EQ(dump(file), dump(path("at-once.sqlite")));
  EXPECT_EQ(StudyReader(file).sessions().size(), 2u);
}

TEST_F(Store, IsNotReplacedByAFreshOne) {
  make_store(file, 10);
  EXPECT_THAT([&] { StudyStore(file, plan_of(10), origin(), Opening::fresh); },
              ThrowsMessage<InvalidInput>(HasSubstr("exists already")));
  EXPECT_EQ(rows_in(file).size(), 10u);
}

TEST_F(Store, FindsTheRowsOfACoarserGridForAFinerOne) {
  {
    StudyStore coarse(file, plan_of(5), origin(), Opening::fresh);
    EXPECT_FALSE(coarse.has_earlier_plans());
    for (int i = 0; i < 5; ++i) coarse.add(row_of(i, i / 4.0));
    EXPECT_FALSE(coarse.find(row_of(0, 0.25).content));
  }
  StudyStore fine(file, plan_of(9), origin(), Opening::resume);
  ASSERT_TRUE(fine.has_earlier_plans());
  int found = 0;
  for (int i = 0; i < 9; ++i) {
    EXPECT_FALSE(fine.done()[static_cast<std::size_t>(i)]);
    if (auto known = fine.find(row_of(i, i / 8.0).content)) {
      ++found;
      known->point = i;
      EXPECT_EQ(dump({*known}), dump({row_of(i, i / 8.0)}));
      fine.add(*known);
    } else {
      fine.add(row_of(i, i / 8.0));
    }
  }
  fine.close();
  EXPECT_EQ(found, 5);
  EXPECT_EQ(StudyReader(file).plan().points, 9);
  EXPECT_EQ(rows_in(file).size(), 9u);
  // The plan with fewer points is still there.
  const StudyStore again(file, plan_of(5), origin(), Opening::resume);
  EXPECT_EQ(again.done(), std::vector<bool>(5, true));
}

TEST_F(Store, GoesOnWithAStudyWhoseFiguresAnotherVersionNamedDifferently) {
  make_store(file, 10);
  StoredPlan renamed = plan_of(10);
  renamed.columns[1].name = "Speed at first contact";
  EXPECT_EQ(StudyStore(file, renamed, origin(), Opening::resume).done(), std::vector<bool>(10, true));
  renamed.text = "the same study with more points";
  renamed.points = 20;
  EXPECT_EQ(StudyStore(file, renamed, origin(), Opening::resume).done(), std::vector<bool>(20, false));
  EXPECT_EQ(StudyStore(file, renamed, origin(), Opening::resume).done(), std::vector<bool>(20, false));
  renamed.columns[0].name = "gap.electrode";
  EXPECT_THAT([&] { StudyStore(file, renamed, origin(), Opening::resume); },
              ThrowsMessage<InvalidInput>(HasSubstr("with other columns")));
}

TEST_F(Store, RefusesAStudyOfOtherColumnsOrOfAnotherPart) {
  make_store(file, 10, {.index = 1, .count = 2});
  StoredPlan other = plan_of(10, {.index = 1, .count = 2});
  other.columns[1].key = "impact_energy_J";
  EXPECT_THAT([&] { StudyStore(file, other, origin(), Opening::resume); },
              ThrowsMessage<InvalidInput>(HasSubstr("it has impact_velocity_m_s where this study has impact_energy_J")));
  other = plan_of(10, {.index = 1, .count = 2});
  other.columns.pop_back();
  EXPECT_THAT([&] { StudyStore(file, other, origin(), Opening::resume); },
              ThrowsMessage<InvalidInput>(HasSubstr("it also has bounce_time_s")));
  EXPECT_THAT([&] { StudyStore(file, plan_of(10, {.index = 1, .count = 4}), origin(), Opening::resume); },
              ThrowsMessage<InvalidInput>(HasSubstr("holds part 1/2 of a study, not 1/4")));
}

TEST_F(Store, RefusesPlansThatItCannotHold) {
  StoredPlan plan = plan_of(10);
  const auto refused = [&](const std::string& with) {
    EXPECT_THAT([&] { StudyStore(file, plan, origin(), Opening::fresh); }, ThrowsMessage<InvalidInput>(HasSubstr(with)));
    EXPECT_FALSE(std::filesystem::exists(file));
  };
  plan.columns[0].key = "gap.contact";
  refused("\"gap.contact\" must be a word");
  plan.columns[0].key = "Status";
  refused("called Status");
  plan.columns[0].key = "BOUNCE_count";
  refused("called bounce_count");
  plan = plan_of(0);
  refused("at least one point");
}

TEST_F(Store, TakesARowOnceAndRefusesOtherBits) {
  StudyStore store(file, plan_of(10), origin(), Opening::fresh);
  store.add(row_of(1));
  store.add(row_of(1));
  store.flush();
  StoredRow other = row_of(1);
  other.values[1] = std::nextafter(other.values[1], 1);
  store.add(other);
  store.add(row_of(2));  // a row of the same batch is kept
  EXPECT_THAT([&] { store.flush(); },
              ThrowsMessage<InvalidInput>(HasSubstr("point 1 already has a different row: impact_velocity_m_s")));
  store.close();
  EXPECT_EQ(dump(file), dump({row_of(1), row_of(2)}));
  std::int64_t counted = 0;
  for (const auto& [status, rows] : StudyReader(file).by_status()) counted += rows;
  EXPECT_EQ(counted, 2);
}

TEST_F(Store, RefusesRowsThatDoNotBelongToThePlan) {
  StudyStore store(file, plan_of(10, {.index = 2, .count = 2}), origin(), Opening::fresh);
  EXPECT_THROW(store.add(row_of(-1)), InvalidInput);
  EXPECT_THROW(store.add(row_of(11)), InvalidInput);
  EXPECT_THROW(store.add(row_of(4)), InvalidInput);  // a row of the other part
  StoredRow short_one = row_of(1);
  short_one.values.pop_back();
  EXPECT_THROW(store.add(short_one), InvalidInput);
  store.close();
  EXPECT_TRUE(rows_in(file).empty());
}

TEST_F(Store, TakesRowsFromManyThreads) {
  {
    StudyStore store(file, plan_of(8000), origin(), Opening::fresh);
    std::vector<std::thread> threads;
    for (int first = 0; first < 4; ++first) {
      threads.emplace_back([&store, first] {
        for (int point = first; point < 8000; point += 4) store.add(row_of(point));
      });
    }
    for (std::thread& thread : threads) thread.join();
    store.close();
  }
  make_store(path("in-order.sqlite"), 8000);
  EXPECT_EQ(dump(file), dump(path("in-order.sqlite")));
}

TEST_F(Store, IsReadWhileItIsWritten) {
  StudyStore store(file, plan_of(4000), origin(), Opening::fresh);
  store.add(row_of(0));
  store.flush();
  const StudyReader reader(file);
  std::size_t seen = 0;
  reader.read([&](const StoredRow&) { ++seen; });
  EXPECT_EQ(seen, 1u);
  for (int point = 1; point < 3000; ++point) store.add(row_of(point));
  store.flush();
  seen = 0;
  reader.read([&](const StoredRow&) { ++seen; });
  EXPECT_EQ(seen, 3000u);
  store.close();  // a reader is still open
  EXPECT_EQ(rows_in(file).size(), 3000u);
}

TEST_F(Store, MakesARowDurableWithinASecondThoughNoneFollows) {
  StudyStore store(file, plan_of(10), origin(), Opening::fresh);
  store.add(row_of(0));
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (rows_in(file).empty() && std::chrono::steady_clock::now() < patience)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(rows_in(file).size(), 1u);
}

TEST(ColumnKey, IsAWordWithItsUnit) {
  EXPECT_EQ(column_key("gap.contact", "m"), "gap_contact_m");
  EXPECT_EQ(column_key("impact_velocity", "m/s"), "impact_velocity_m_s");
  EXPECT_EQ(column_key("contact.asperity_density", "1/m^2"), "contact_asperity_density_1_m2");
  EXPECT_EQ(column_key("gas.viscosity", "Pa s"), "gas_viscosity_Pa_s");
  EXPECT_EQ(column_key("bounce_count", ""), "bounce_count");
}

TEST(AShard, HoldsEveryPointInOneOfThem) {
  for (const std::int64_t points : {1, 7, 8, 9, 100}) {
    std::int64_t held = 0;
    for (int index = 1; index <= 8; ++index) {
      const Shard shard{.index = index, .count = 8};
      std::int64_t counted = 0;
      for (std::int64_t point = 0; point < points; ++point) counted += shard.contains(point) ? 1 : 0;
      EXPECT_EQ(shard.size(points), counted) << index << " of " << points;
      held += counted;
    }
    EXPECT_EQ(held, points);
  }
}

TEST(AShard, IsReadFromText) {
  EXPECT_EQ(shard_from("3/8"), (Shard{.index = 3, .count = 8}));
  for (const char* wrong : {"", "3", "3/", "/8", "0/8", "9/8", "-1/8", "3/8 ", "3/8/2", "a/b", "99999999999/99999999999"})
    EXPECT_THAT([&] { static_cast<void>(shard_from(wrong)); },
                ThrowsMessage<InvalidInput>(HasSubstr("must be a part i/N of a study")))
        << wrong;
}

}  // namespace
}  // namespace softland::test
