// A writer that is killed repeatedly has in the end the rows of a writer that was not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "base/clock.h"
#include "tests/store/sample.h"

namespace softland::test {
namespace {

using Opening = StudyStore::Opening;
using Kill = WithStore;

constexpr std::int64_t points = 60'000;

// The writer's report in memory that outlives it.
struct WriterReport {
  std::atomic<bool> writes = false;  ///< true while the store is open
  std::atomic<std::int64_t> taken = 0;
  std::array<double, points> when{};  ///< time at which each row was taken [s]
};

struct Pace {
  int rows;                        ///< number of rows between two pauses
  std::chrono::microseconds rest;  ///< so long that the writer is killed before it is done
};

// Writes the missing rows until it is done or killed.
[[noreturn]] void write_on(const std::filesystem::path& file, WriterReport& told, Pace pace) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  StudyStore store(file, plan_of(points), origin(), Opening::resume);
  const std::vector<bool> done = store.done();
  told.writes = true;
  for (std::int64_t point = 0; point < points; ++point) {
    if (done[static_cast<std::size_t>(point)]) continue;
    store.add(row_of(point));
    told.when[static_cast<std::size_t>(point)] = wall_clock();
    told.taken = point + 1;
    if (point % pace.rows == 0) std::this_thread::sleep_for(pace.rest);
  }
  store.close();
  ::_exit(0);
}

class Writer {
 public:
  Writer(const std::filesystem::path& file, WriterReport& told, Pace pace) : told_(told) {
    told.writes = false;
    child_ = ::fork();
    if (child_ == 0) write_on(file, told, pace);
  }
  // Waits until the writer has opened the store, for at most a minute.
  void await() const {
    for (int i = 0; i < 60'000 && !told_.writes; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_TRUE(told_.writes);
  }
  // Kills the writer; returns true if it was still running.
  bool kill() const {
    ::kill(child_, SIGKILL);
    int status = 0;
    ::waitpid(child_, &status, 0);
    return WIFSIGNALED(status);
  }

 private:
  WriterReport& told_;
  pid_t child_;
};

TEST_F(Kill, FiftyTimesEndsWithTheSameBits_slow) {
  auto* told =
      new (::mmap(nullptr, sizeof(WriterReport), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) WriterReport;
  std::mt19937 random(20260131);
  std::uniform_real_distribution<double> part(0, 1);
  constexpr int kills = 50, while_opening = 12;
  int at_work = 0;
  std::size_t held = 0;
  for (int k = 0; k < kills; ++k) {
    const Writer writer(file, *told, {.rows = 25, .rest = std::chrono::milliseconds(1)});
    if (k >= while_opening) writer.await();
    std::this_thread::sleep_for(std::chrono::duration<double>(part(random) * (k >= while_opening ? 0.1 : 0.02)));
    at_work += writer.kill() ? 1 : 0;
    if (!std::filesystem::exists(file)) continue;
    const std::vector<StoredRow> rows = rows_in(file);
    ASSERT_GE(rows.size(), held) << "of what was durable nothing is lost";
    held = rows.size();
    ASSERT_EQ(dump(rows), dump([&] {
                std::vector<StoredRow> expected;
                for (std::size_t point = 0; point < held; ++point) expected.push_back(row_of(static_cast<std::int64_t>(point)));
                return expected;
              }()))
        << "rows become durable in the order in which they were taken";
  }
  EXPECT_GE(at_work, 45);
  EXPECT_GT(held, 0u);
  EXPECT_LT(held, static_cast<std::size_t>(points));

  // Rows that come slowly become durable by time alone. On a busy disk the last second is lost; allow three and a half.
  const Writer slow(file, *told, {.rows = 1, .rest = std::chrono::milliseconds(5)});
  slow.await();
  std::this_thread::sleep_for(std::chrono::milliseconds(4500));
  const double killed = wall_clock();
  EXPECT_TRUE(slow.kill());
  const std::size_t durable = rows_in(file).size();
  ASSERT_GT(told->taken, static_cast<std::int64_t>(durable) - 1);
  for (auto point = static_cast<std::size_t>(told->taken) - 1; point >= durable; --point)
    ASSERT_GT(told->when[point], killed - seconds_per_commit - 2.5) << "point " << point << " is lost";
  EXPECT_GT(durable, held);

  StudyStore last(file, plan_of(points), origin(), Opening::resume);
  const std::vector<bool> done = last.done();
  for (std::int64_t point = 0; point < points; ++point) {
    if (!done[static_cast<std::size_t>(point)]) last.add(row_of(point));
  }
  last.close();
  make_store(path("undisturbed.sqlite"), points);
  EXPECT_TRUE(dump(file) == dump(path("undisturbed.sqlite")));
  EXPECT_EQ(StudyReader(file).by_status(), StudyReader(path("undisturbed.sqlite")).by_status());
  EXPECT_THAT(names_in(TemporaryFolder::path()),
              ::testing::IsSupersetOf({std::string("study.sqlite"), std::string("undisturbed.sqlite")}));
  ::munmap(told, sizeof(WriterReport));
}

}  // namespace
}  // namespace softland::test
