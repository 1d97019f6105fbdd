#include "base/executor.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <latch>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/require.h"

namespace softland {
namespace {

constexpr int most_threads = 256;  // largest number of threads of a loop; oneTBB permits no more on machines of up to 64 cores

// Returns how many further threads the machine can start now, at most `wanted`.
int threads_available(int wanted) {
  std::latch counted(1);
  std::vector<std::jthread> probes;
  probes.reserve(static_cast<std::size_t>(wanted));
  try {
    while (static_cast<int>(probes.size()) < wanted) probes.emplace_back([&] { counted.wait(); });
  } catch (const std::system_error&) {
    // The machine cannot start another thread: the number of those that it started is the result.
  }
  counted.count_down();
  return static_cast<int>(probes.size());
}

// The threads of oneTBB. oneTBB ends the process when it cannot start a permitted thread, and it starts threads late, one by
// one. So this class permits only as many threads as the machine can start now, and makes oneTBB start them all at once.
class Workers {
 public:
  // The instance is never destroyed: its oneTBB threads end with the process, not before.
  static Workers& instance() {
    static auto* const workers = new Workers;
    return *workers;
  }

  // Provides `wanted` threads besides the calling one, or as many as the machine can start. Returns their number.
  int provide(int wanted) {
    const std::scoped_lock lock(mutex_);
    if (wanted > count_) {
      if (const int more = threads_available(wanted - count_); more > 0) start(count_ + more);
      wanted = std::min(wanted, count_);
    }
    return wanted;
  }

 private:
  Workers() {
    kept_.initialize();
    permit(0);
  }

  void permit(int count) {
    count_ = count;
    // oneTBB applies the lowest of all limits that exist. A higher limit acts once this assignment has destroyed the previous
    // one.
    limit_ =
        std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count) + 1);
  }

  // Makes oneTBB start `count` worker threads at once: every worker gets a task that ends only when all workers have begun
  // their tasks, so that one worker cannot take two of the tasks.
  void start(int count) {
    permit(count);
    {
      const std::scoped_lock lock(meeting_);
      missing_ = count;
    }
    tbb::task_arena arena(count + 1);
    for (int k = 0; k < count; ++k) arena.enqueue([this] { meet(1); });
    meet(0);
  }

  void meet(int arriving) {
    // The longest wait until all workers have begun their task. A worker that is busy in another loop may begin later: waiting
    // for it is not necessary, since oneTBB has started its thread already.
    constexpr std::chrono::seconds patience{1};
    std::unique_lock lock(meeting_);
    missing_ -= arriving;
    if (missing_ <= 0) all_here_.notify_all();
    all_here_.wait_for(lock, patience, [this] { return missing_ <= 0; });
  }

  std::mutex mutex_;  // lets one thread at a time run provide()
  int count_ = 0;
  std::unique_ptr<tbb::global_control> limit_;
  tbb::task_arena kept_{1};  // exists so that an arena always does: oneTBB ends its threads with the last arena

  std::mutex meeting_;
  std::condition_variable all_here_;
  int missing_ = 0;
};

// Makes what a thread wrote before this call visible to the thread that makes the next call. oneTBB also ensures this, but in a
// way that the thread sanitizer cannot see.
void hand_over() {
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);
}

// Number of threads of the loop whose task the current thread runs, which a nested loop shares; 0 outside of any loop.
[[gnu::tls_model("initial-exec")]] thread_local int threads_of_loop = 0;

class Loop {
 public:
  Loop(std::size_t count, int threads, const std::function<void(std::size_t)>& task, const std::atomic<bool>* stop)
      : count_(count), threads_(threads), task_(task), stop_(stop), end_(count) {}

  // Runs tasks until all tasks have been begun; every thread of the loop calls this function. The threads take tasks in order,
  // so that all tasks before a task that throws have been begun.
  void work() {
    const int outer = std::exchange(threads_of_loop, threads_);
    while (stop_ == nullptr || !stop_->load(std::memory_order_relaxed)) {
      const std::size_t k = next_++;
      if (k >= end_) break;
      try {
        task_(k);
      } catch (...) {
        const std::scoped_lock lock(mutex_);
        if (k < end_) {
          end_ = k;
          failure_ = std::current_exception();
        }
      }
    }
    threads_of_loop = outer;
  }

  // Calls work() on all threads of the oneTBB arena in which the loop runs, on at most one thread per task.
  void work_together() {
    hand_over();
    const auto help = [this] {
      hand_over();
      work();
      hand_over();
    };
    tbb::task_group helpers;
    for (std::size_t k = 1; k < std::min(count_, static_cast<std::size_t>(threads_)); ++k) helpers.run(help);
    helpers.run_and_wait([this] { work(); });
    hand_over();
  }

  // Returns the number of tasks that were begun; rethrows the exception of a task, the one with the lowest index if several
  // threw.
  [[nodiscard]] std::size_t result() const {
    if (failure_) std::rethrow_exception(failure_);
    return std::min(next_.load(), count_);
  }

 private:
  std::size_t count_;
  int threads_;
  const std::function<void(std::size_t)>& task_;
  const std::atomic<bool>* stop_;
  std::atomic<std::size_t> next_ = 0, end_;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace

std::size_t run_tasks(std::size_t count, int jobs, const std::function<void(std::size_t)>& task, const std::atomic<bool>* stop) {
  require(jobs >= 1, "jobs = " + std::to_string(jobs) + " must be at least 1");
  if (count == 0) return 0;
  const bool nested = threads_of_loop > 0;
  const int threads = nested     ? std::min(jobs, threads_of_loop)
                      : jobs > 1 ? 1 + Workers::instance().provide(std::min(jobs, most_threads) - 1)
                                 : 1;
  Loop loop(count, threads, task, stop);
  if (threads == 1) {
    loop.work();
  } else if (nested) {
    // Isolation is necessary: otherwise this thread, while it waits for an inner loop in a task of the outer loop, could begin
    // another task of the outer loop.
    tbb::this_task_arena::isolate([&] { loop.work_together(); });
  } else {
    tbb::task_arena(threads).execute([&] { loop.work_together(); });
  }
  return loop.result();
}

}  // namespace softland
