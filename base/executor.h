// Independent tasks on several threads. A loop over tasks has the effects of a sequential loop, and throws the same exception,
// whichever threads run the tasks and when.
//
// The threads are those of oneTBB: one pool per process, started when first needed, and ended with the process. When the
// machine cannot start further threads, the existing ones do the work, at least the calling thread.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace softland {

/// Runs task(0), ..., task(count - 1), begun in this order, on at most `jobs` threads including the calling thread, and returns
/// when all tasks have ended. A task must not depend on the effects of another task.
///
/// A task that throws ends the loop: tasks before it complete, later tasks are not begun any more, and the exception is
/// rethrown. If several tasks throw, the exception of the lowest index is rethrown. Once `stop` is set no task is begun.
/// Returns the number of tasks that were begun, task(0) to task(number - 1); without a stop this number is `count`.
///
/// Loops may be nested: they share the threads of the outermost loop, and an inner loop uses at most `jobs` threads at a time.
/// A loop never has more than 256 threads. Throws InvalidInput unless jobs >= 1.
std::size_t run_tasks(std::size_t count, int jobs, const std::function<void(std::size_t)>& task,
                      const std::atomic<bool>* stop = nullptr);

}  // namespace softland
