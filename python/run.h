// Runs a computation for Python: without the GIL, interruptible by Ctrl-C, with Python callbacks for its progress.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>

#include "base/monotone_progress.h"
#include "base/progress.h"

namespace softland::python {

/// During its lifetime, SIGINT sets a flag and is then passed on to Python. A computation in the main thread stops, and Python
/// raises KeyboardInterrupt. In other threads, to which Python delivers no signals, this class does nothing.
class StoppedByInterrupt {
 public:
  explicit StoppedByInterrupt(std::atomic<bool>& stop);
  StoppedByInterrupt(const StoppedByInterrupt&) = delete;
  StoppedByInterrupt& operator=(const StoppedByInterrupt&) = delete;
  ~StoppedByInterrupt();

 private:
  int place_ = -1;
};

/// One call from Python into the library.
class InterruptibleRun {
 public:
  /// `on_progress` is a Python function that is called with the name of the current stage and its completed share, at most ten
  /// times a second; or None.
  explicit InterruptibleRun(pybind11::object on_progress = pybind11::none());
  InterruptibleRun(const InterruptibleRun&) = delete;
  InterruptibleRun& operator=(const InterruptibleRun&) = delete;

  /// Returns the result of work(progress), run without the GIL. Raises an exception of a Python callback, KeyboardInterrupt
  /// after Ctrl-C, and exceptions that `work` throws.
  template <class Work>
  auto operator()(Work&& work) {
    std::optional<std::invoke_result_t<Work, const Progress&>> result;
    std::exception_ptr error;
    {
      const StoppedByInterrupt guard(stop_);
      const pybind11::gil_scoped_release free;
      try {
        result.emplace(work(progress_));
      } catch (...) {
        error = std::current_exception();
      }
    }
    finish(error);
    return std::move(*result);
  }

  [[nodiscard]] const Progress& progress() const { return progress_; }
  [[nodiscard]] const std::atomic<bool>* stop() const { return &stop_; }
  /// Returns true after Ctrl-C or an exception of a Python function, which end the work without a result; false if a callback
  /// has ended the work by end_by_wish().
  [[nodiscard]] bool given_up() const { return stop_.load(std::memory_order_relaxed) && !ended_by_wish_; }
  /// For callbacks of the library: throws Interrupted, to end the work, after Ctrl-C or an exception of a Python function.
  void throw_if_given_up() const {
    if (given_up()) throw Interrupted();
  }
  /// Calls a Python function from any thread. The first exception of a Python function ends the work, and is raised afterwards.
  template <class Call>
  void call(Call&& call) {
    const pybind11::gil_scoped_acquire held;
    try {
      call();
    } catch (pybind11::error_already_set&) {
      keep(std::current_exception());
    }
  }
  /// Keeps an exception and stops the computation. Without the stop, the library would treat the exception as an infeasible
  /// waveform.
  void keep(std::exception_ptr error);

 private:
  void finish(const std::exception_ptr& error);

  std::atomic<bool> stop_ = false, ended_by_wish_ = false;
  std::mutex lock_;
  std::exception_ptr first_;
  pybind11::object on_progress_;
  std::atomic<std::chrono::steady_clock::rep> last_noted_ = 0;
  std::mutex progress_lock_;  // guards `shown_` and `progress_`, since several threads may report progress
  MonotoneProgress shown_;
  Progress progress_;

 public:
  /// Ends the computation because a callback returned True; the result is the best waveform or point so far.
  void end_by_wish() {
    ended_by_wish_ = true;
    stop_ = true;
  }
};

}  // namespace softland::python
