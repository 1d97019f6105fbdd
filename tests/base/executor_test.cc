#include "base/executor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/require.h"

namespace softland {
namespace {

using namespace std::chrono_literals;

constexpr int job_counts[] = {1, 2, 3, 8};

/// Waits until `holds` returns true, until a few seconds after `begin`, so that a test fails instead of hanging. Returns
/// whether it does.
bool wait_until(const std::function<bool()>& holds, std::chrono::steady_clock::time_point begin) {
  while (!holds() && std::chrono::steady_clock::now() < begin + 5s) std::this_thread::sleep_for(1ms);
  return holds();
}

/// Counts the threads that are between entry and exit at the same time.
class Crowd {
 public:
  void enter() {
    const int now = ++inside_;
    for (int most = most_; most < now && !most_.compare_exchange_weak(most, now);) {
    }
  }
  void leave() { --inside_; }
  [[nodiscard]] int most() const { return most_; }
  [[nodiscard]] bool wait_for(int all) const {
    return wait_until([&] { return most_ >= all; }, begin_);
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::atomic<int> inside_ = 0, most_ = 0;
};

TEST(RunTasks, RunsEachTaskOnceForAnyNumberOfJobs) {
  for (const int jobs : job_counts) {
    for (const std::size_t count : {0U, 1U, 2U, 7U, 100'000U}) {
      std::vector<std::size_t> squares(count);
      const auto task = [&](std::size_t k) { squares[k] += k * k + 1; };
      EXPECT_EQ(run_tasks(count, jobs, task), count);
      for (std::size_t k = 0; k < count; ++k) EXPECT_EQ(squares[k], k * k + 1) << jobs << ' ' << k;
    }
  }
}

TEST(RunTasks, RunsOneAfterTheOtherWithOneJob) {
  std::vector<std::size_t> order, expected(20);
  std::iota(expected.begin(), expected.end(), 0u);
  const auto caller = std::this_thread::get_id();
  run_tasks(20, 1, [&](std::size_t k) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    order.push_back(k);
  });
  EXPECT_EQ(order, expected);
}

// Holds on a machine with fewer cores as well: a search with --jobs 8 has eight evaluations in progress, which may wait.
TEST(RunTasks, HasAsManyTasksUnderWayAsJobsAndNeverMore) {
  for (const int jobs : job_counts) {
    Crowd crowd;
    run_tasks(200, jobs, [&](std::size_t) {
      crowd.enter();
      EXPECT_TRUE(crowd.wait_for(jobs));
      std::this_thread::sleep_for(100us);
      crowd.leave();
    });
    EXPECT_EQ(crowd.most(), jobs);
  }
}

std::string message_of(const std::function<void()>& run) {
  try {
    run();
  } catch (const std::exception& thrown) {
    return thrown.what();
  }
  return "nothing was thrown";
}

// Tasks 3 and 5 fail; with eight jobs both run at the same time and fail in either order.
TEST(RunTasks, ThrowsWhatTheFirstOfSeveralFailingTasksThrewWhicheverFailsSooner) {
  for (const std::size_t sooner : {3U, 5U}) {
    for (const int jobs : job_counts) {
      const auto begin = std::chrono::steady_clock::now();
      std::atomic<int> begun = 0;
      std::atomic<bool> one_failed = false;
      std::vector<std::atomic<int>> completed(6);
      const auto task = [&](std::size_t k) {
        if (k > 5) return;
        ++begun;
        if (jobs == 8) {
          EXPECT_TRUE(wait_until([&] { return begun == 6 && (k == sooner || one_failed); }, begin));
          std::this_thread::sleep_for(k == sooner ? 0ms : 2ms);
        }
        one_failed = one_failed || k == sooner;
        if (k == 3 || k == 5) throw std::runtime_error("task " + std::to_string(k));
        ++completed[k];
      };
      EXPECT_EQ(message_of([&] { run_tasks(100, jobs, task); }), "task 3") << jobs;
      for (const std::size_t before : {0U, 1U, 2U}) EXPECT_EQ(completed[before], 1) << jobs << ": tasks before it complete";
      EXPECT_EQ(run_tasks(10, jobs, [](std::size_t) {}), 10u) << "the threads are there for the next loop";
    }
  }
}

TEST(RunTasks, BeginsNoTaskAfterOneThatFailed) {
  for (const int jobs : job_counts) {
    std::atomic<std::size_t> begun = 0;
    const auto task = [&](std::size_t k) {
      ++begun;
      if (k == 0) throw std::runtime_error("task 0");
      std::this_thread::sleep_for(1ms);
    };
    EXPECT_EQ(message_of([&] { run_tasks(10'000, jobs, task); }), "task 0");
    EXPECT_LT(begun, 5'000u);
    if (jobs == 1) {
      EXPECT_EQ(begun, 1u);
    }
  }
}

TEST(RunTasks, AskedToStopLeavesOutTheLastTasks) {
  for (const int jobs : job_counts) {
    std::atomic<bool> stop = false;
    std::vector<int> ran(10'000);
    const auto task = [&](std::size_t k) {
      ran[k] = 1;
      if (k == 7) stop = true;
      std::this_thread::sleep_for(10us);
    };
    const std::size_t begun = run_tasks(ran.size(), jobs, task, &stop);
    EXPECT_GE(begun, 8u);
    EXPECT_LT(begun, ran.size());
    if (jobs == 1) {
      EXPECT_EQ(begun, 8u);
    }
    for (std::size_t k = 0; k < ran.size(); ++k) EXPECT_EQ(ran[k], k < begun) << jobs << ' ' << k;
    EXPECT_EQ(run_tasks(10, jobs, task, &stop), 0u) << "stopped before it began";
  }
}

TEST(RunTasks, NestedShareTheThreadsOfTheOutermostLoop) {
  for (const int outer : job_counts) {
    for (const int inner : job_counts) {
      Crowd crowd;
      std::vector<std::vector<std::size_t>> sums(12, std::vector<std::size_t>(12));
      run_tasks(12, outer, [&](std::size_t i) {
        run_tasks(12, inner, [&](std::size_t k) {
          crowd.enter();
          std::this_thread::sleep_for(50us);
          sums[i][k] = i + k;
          crowd.leave();
        });
      });
      EXPECT_LE(crowd.most(), outer);
      for (std::size_t i = 0; i < 12; ++i) {
        for (std::size_t k = 0; k < 12; ++k) EXPECT_EQ(sums[i][k], i + k);
      }
    }
  }
}

// Threads without a task of the outer loop work for an inner loop.
TEST(RunTasks, NestedUseThreadsThatAreFree) {
  Crowd crowd;
  run_tasks(1, 3, [&](std::size_t) {
    run_tasks(3, 3, [&](std::size_t) {
      crowd.enter();
      EXPECT_TRUE(crowd.wait_for(3));
      crowd.leave();
    });
  });
  EXPECT_EQ(crowd.most(), 3);
}

TEST(RunTasks, NestedThrowThroughBothLoops) {
  for (const int jobs : job_counts) {
    const auto run = [&] {
      run_tasks(4, jobs, [&](std::size_t i) {
        run_tasks(4, jobs, [&](std::size_t k) {
          if (i >= 1 && k >= 2) throw std::runtime_error(std::to_string(i) + " " + std::to_string(k));
        });
      });
    };
    EXPECT_EQ(message_of(run), "1 2") << jobs;
  }
}

// A task of the outer loop that began inside of another one could wait for a lock that the other task holds.
TEST(RunTasks, NestedBeginNoOuterTaskWhileTheyWait) {
  static thread_local bool in_outer_task = false;
  std::atomic<int> within_another = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    run_tasks(16, 8, [&](std::size_t i) {
      within_another += in_outer_task;
      in_outer_task = true;
      run_tasks(8, 8, [&](std::size_t k) {
        const bool own = in_outer_task;
        in_outer_task = false;  // a helping thread is in no outer task
        std::this_thread::sleep_for(std::chrono::microseconds(10 * ((i + k) % 7)));
        in_outer_task = own;
      });
      in_outer_task = false;
    });
  }
  EXPECT_EQ(within_another, 0);
}

TEST(RunTasks, MayBeCalledFromSeveralThreads) {
  std::vector<std::jthread> callers;
  std::atomic<int> ran = 0;
  for (int k = 0; k < 4; ++k) {
    callers.emplace_back([&ran, k] { run_tasks(100, 1 + k, [&](std::size_t) { ++ran; }); });
  }
  callers.clear();
  EXPECT_EQ(ran, 400);
}

TEST(RunTasks, RefusesToRunOnNoThread) {
  EXPECT_EQ(message_of([] { run_tasks(1, 0, [](std::size_t) {}); }), "jobs = 0 must be at least 1");
}

/// Limits the number of threads that this process can still start. Root has no such limit, and so becomes another user first.
void limit_threads(rlim_t further) {
  constexpr uid_t nobody_else = 54'321;
  if (geteuid() == 0 && setuid(nobody_else) != 0) std::_Exit(2);
  const bool counts = geteuid() == nobody_else;  // another user may already have processes, and then gets no thread
  const rlim_t all = counts ? 1 + further : 1;
  const rlimit limit{.rlim_cur = all, .rlim_max = all};
  if (setrlimit(RLIMIT_NPROC, &limit) != 0) std::_Exit(3);
}

// oneTBB itself would end the process if it cannot start a thread.
TEST(RunTasks, MakeDoWithTheThreadsThatTheMachineHas) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const rlim_t further : {0U, 1U, 3U}) {
    const auto run = [&] {
      limit_threads(further);
      Crowd crowd;
      std::atomic<int> ran = 0;
      for (int loop = 0; loop < 3; ++loop) {
        run_tasks(50, 8, [&](std::size_t) {
          crowd.enter();
          std::this_thread::sleep_for(2ms);
          crowd.leave();
          ++ran;
        });
      }
      std::fprintf(stderr, "%d tasks, %s", ran.load(),
                   crowd.most() <= 1 + static_cast<int>(further) ? "done" : "too many at once");
      std::_Exit(0);
    };
    EXPECT_EXIT(run(), testing::ExitedWithCode(0), "150 tasks, done") << further;
  }
}

TEST(RunTasks, HaveTheirThreadsFromTheFirstLoopOn) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto run = [] {
    run_tasks(1, 4, [](std::size_t) {});
    limit_threads(0);
    Crowd crowd;
    run_tasks(50, 4, [&](std::size_t) {
      crowd.enter();
      static_cast<void>(crowd.wait_for(4));
      crowd.leave();
    });
    std::fprintf(stderr, "%d at once", crowd.most());
    std::_Exit(0);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(0), "4 at once");
}

}  // namespace
}  // namespace softland
