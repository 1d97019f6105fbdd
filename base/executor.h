// Independent tasks on several threads. A loop does and throws what a sequential loop over its tasks would, whichever thread
// runs a task, and whenever.
//
// The threads are those of oneTBB, one pool for the process, started when they are first needed and kept. Where the machine is
// out of threads, the existing ones do the work, the calling one at least.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace softland {

/// Runs task(0), ..., task(count - 1), begun in this order, on at most `jobs` threads, the calling one among them, and returns
/// when all have ended. A task must not depend on what another one does.
///
/// A task that throws ends the loop: tasks before it complete, those after it are not begun any more, and the exception is
/// rethrown. If several throw, the exception of the lowest index is rethrown. Once `stop` is set no task is begun. Returns the
/// number of tasks begun, which are the first ones; it is `count` for a loop that is not asked to stop.
///
/// Loops may be nested: they share the threads of the outermost one, and an inner one uses at most `jobs` of them at a time.
/// There are never more than 256. Throws InvalidInput unless jobs >= 1.
std::size_t run_tasks(std::size_t count, int jobs, const std::function<void(std::size_t)>& task,
                      const std::atomic<bool>* stop = nullptr);

}  // namespace softland
