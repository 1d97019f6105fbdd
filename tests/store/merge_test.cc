// Merges parts of a study.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <limits>

#include "base/require.h"
#include "tests/store/sample.h"

namespace softland::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::ThrowsMessage;
using Opening = StudyStore::Opening;
namespace fs = std::filesystem;

struct Merge : WithStore {
  std::vector<fs::path> parts_of(std::int64_t points, int count) {
    std::vector<fs::path> parts;
    for (int index = 1; index <= count; ++index) {
      parts.emplace_back(path(fmt::format("part {}.sqlite", index)));
      make_store(parts.back(), points, {.index = index, .count = count});
    }
    return parts;
  }
};

TEST_F(Merge, OfAllPartsHasTheBitsOfTheUnsharedStudy) {
  const Merged merged = merge_studies(parts_of(5003, 8), file, origin());
  make_store(path("whole.sqlite"), 5003);
  EXPECT_EQ(dump(file), dump(path("whole.sqlite")));
  EXPECT_EQ(merged.rows, 5003);
  EXPECT_THAT(merged.notes, IsEmpty());
  EXPECT_EQ(StudyReader(file).by_status(), StudyReader(path("whole.sqlite")).by_status());
  EXPECT_EQ(StudyReader(file).plan().shard, Shard{});
  EXPECT_EQ(StudyReader(file).sessions().size(), 9u);
  // The merged store can be continued.
  EXPECT_EQ(StudyStore(file, plan_of(5003), origin(), Opening::resume).done(), std::vector<bool>(5003, true));
}

TEST_F(Merge, TakesPartsWhoseFiguresTwoVersionsNamedDifferently) {
  const std::vector<fs::path> parts = parts_of(10, 1);
  StoredPlan renamed = plan_of(10);
  renamed.columns[1].name = "Speed at first contact";
  const fs::path other = path("other.sqlite");
  StudyStore(other, renamed, origin(), Opening::fresh).close();
  EXPECT_EQ(merge_studies({parts[0], other}, file, origin()).rows, 10);
}

TEST_F(Merge, TellsWhatIsMissing) {
  std::vector<fs::path> parts = parts_of(100, 4);
  parts.erase(parts.begin() + 1);
  const Merged merged = merge_studies(parts, file, origin());
  EXPECT_EQ(merged.rows, 75);
  EXPECT_THAT(merged.notes, ElementsAre("25 of 100 points are missing", "no part was given for 2/4"));
}

TEST_F(Merge, ThatIsToBeCompleteWritesNothingBefore) {
  std::vector<fs::path> parts = parts_of(100, 2);
  const fs::path last = parts.back();
  parts.pop_back();
  EXPECT_FALSE(merge_studies(parts, file, origin(), {.complete = true}).written);
  EXPECT_FALSE(fs::exists(file));
  parts.push_back(last);
  EXPECT_TRUE(merge_studies(parts, file, origin(), {.complete = true}).written);
  EXPECT_EQ(rows_in(file).size(), 100u);
}

TEST_F(Merge, OfMergedPartsIsTheSame) {
  const std::vector<fs::path> parts = parts_of(100, 4);
  static_cast<void>(merge_studies({parts[0], parts[1]}, path("a"), origin()));
  static_cast<void>(merge_studies({parts[1], parts[2], parts[3]}, path("b"), origin()));
  EXPECT_THAT(merge_studies({path("b"), path("a")}, file, origin()).notes, IsEmpty());  // rows in both stores have the same bits
  EXPECT_EQ(rows_in(file).size(), 100u);
}

TEST_F(Merge, RefusesOtherBitsForOnePoint) {
  make_store(path("a"), 100);
  {
    StudyStore store(path("b"), plan_of(100), origin(), Opening::fresh);
    StoredRow row = row_of(17);
    row.values[1] = std::nextafter(row.values[1], 1);
    store.add(row);
  }
  EXPECT_THAT(
      [&] {
        static_cast<void>(merge_studies({path("a"), path("b")}, file, origin()));
      },
      ThrowsMessage<InvalidInput>(AllOf(
          HasSubstr("/a and "), HasSubstr("/b must hold the same row for point 17, but differ in impact_velocity_m_s 0.2"))));
  EXPECT_THAT(names_in(TemporaryFolder::path()), ElementsAre("a", "b"));
}

TEST_F(Merge, RefusesWhatDoesNotBelongTogether) {
  make_store(path("a"), 100);
  make_store(path("b"), 99);
  const auto refused = [&](const std::vector<fs::path>& parts, const fs::path& out, const std::string& reason) {
    EXPECT_THAT([&] { static_cast<void>(merge_studies(parts, out, origin())); }, ThrowsMessage<InvalidInput>(HasSubstr(reason)));
  };
  refused({path("a"), path("b")}, file, "must have the same plan as");
  refused({path("a"), path("a")}, file, "must not be given twice");
  refused({path("a")}, path("b"), "exists already; it is not replaced");
  refused({path("a")}, path("a"), "exists already; it is not replaced");
  refused({path("a"), path("nothing")}, file, "the file does not exist");
  refused({}, file, "at least one part");
  EXPECT_THAT(names_in(TemporaryFolder::path()), ElementsAre("a", "b"));
}

TEST_F(Merge, TellsOfSeveralProgramsAndProcessors) {
  for (int index = 1; index <= 2; ++index) {
    StudyStore store(
        path(std::to_string(index)), plan_of(2, {.index = index, .count = 2}),
        {.program = fmt::format("softland {}", index), .processor = fmt::format("processor {}", index), .command = ""},
        Opening::fresh);
    store.add(row_of(index - 1));
  }
  std::vector<std::string> notes =
      merge_studies({path("1"), path("2")}, file, {.program = "softland 1", .processor = "processor 1", .command = ""}).notes;
  EXPECT_THAT(notes, ElementsAre("the parts were computed by several programs: softland 1; softland 2",
                                 "the parts were computed on several processors: processor 1; processor 2"));
}

TEST_F(Merge, StopsWhenItIsAsked) {
  make_store(path("a"), 100);
  const std::atomic<bool> stop = true;
  EXPECT_THROW(static_cast<void>(merge_studies({path("a")}, file, origin(), {.progress = {.stop = &stop}})), Interrupted);
  EXPECT_FALSE(fs::exists(file));
}

TEST_F(Merge, OfMorePartsThanAProcessMayEverOpenSaysSo) {
  const std::vector<fs::path> parts = parts_of(24, 12);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const rlimit limit{14, 14};
    ::setrlimit(RLIMIT_NOFILE, &limit);
    EXPECT_THAT([&] { static_cast<void>(merge_studies(parts, file, origin())); },
                ThrowsMessage<InvalidInput>(AllOf(HasSubstr("Too many open files"), Not(HasSubstr("not a store")))));
    ::_exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << "see the failures above";
}

TEST_F(Merge, NamesTheFirstOfManyPartsThatAreMissing) {
  const int most = std::numeric_limits<int>::max();
  make_store(path("a"), 10, {.index = 1, .count = most});
  make_store(path("b"), 10, {.index = 3, .count = most});
  const std::vector<std::string> notes = merge_studies({path("a"), path("b")}, file, origin()).notes;
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_THAT(notes[1], AllOf(HasSubstr("no part was given for 2/2147483647, 4/2147483647, "), HasSubstr("and 2147483625 more")));
}

TEST_F(Merge, OfMorePartsThanAProcessMayOpenFilesAsksForMore) {
  const std::vector<fs::path> parts = parts_of(24, 12);
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
  const rlim_t before = std::exchange(limit.rlim_cur, 14);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
  EXPECT_EQ(merge_studies(parts, file, origin()).rows, 24);
  limit.rlim_cur = before;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace
}  // namespace softland::test
