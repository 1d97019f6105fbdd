// Independent tasks on several threads. Which thread runs a task, and when, decides nothing: a loop does and throws what a
// sequential loop over its tasks would.
//
// The threads are those of oneTBB, one pool for the process, started when they are first asked for and kept. Where the machine is
// out of threads, those there are do the work, the calling one at least.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace softland {

/// Runs task(0), ..., task(count - 1), begun in this order, on at most `jobs` threads, the calling one among them, and returns
/// when all have ended. A task must not depend on what another one does.
///
/// A task that throws ends the loop: tasks before it complete, those after it are not begun any more, and the exception is
/// rethrown; of several that of the lowest index. Once `stop` is set no task is begun; the result is the number of tasks that
/// were, which are the first ones. It is `count` for a loop that is not asked to stop.
///
/// Loops may be nested: the threads of the outermost one are all there are, and an inner one uses at most `jobs` of them at a
/// time. There are never more than 256. Throws InvalidInput unless jobs >= 1.
std::size_t run_tasks(std::size_t count, int jobs, const std::function<void(std::size_t)>& task,
                      const std::atomic<bool>* stop = nullptr);

}  // namespace softland
