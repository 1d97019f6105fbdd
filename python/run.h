// Runs a computation under Python: without the GIL, stopped by Ctrl-C, and with Python functions that get its progress.
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
#include "base/watch.h"

namespace softland::python {

/// While it lives a SIGINT sets this flag as soon as it comes, and is then left to Python: what computes in the main thread
/// stops, and Python raises KeyboardInterrupt when it is back. In other threads, where Python delivers no signal, it does
/// nothing.
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
class Run {
 public:
  /// `progress`: called with what is being computed and which part of it is done, at most ten times a second. None: no
  /// progress is reported.
  explicit Run(pybind11::object progress = pybind11::none());
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// Returns the result of work(watch), run without the GIL. Raises what Python raised in one of its functions,
  /// KeyboardInterrupt where Ctrl-C stopped it, and what the work throws.
  template <class Work>
  auto operator()(Work&& work) {
    std::optional<std::invoke_result_t<Work, const Watch&>> result;
    std::exception_ptr error;
    {
      const StoppedByInterrupt guard(stop_);
      const pybind11::gil_scoped_release free;
      try {
        result.emplace(work(watch_));
      } catch (...) {
        error = std::current_exception();
      }
    }
    finish(error);
    return std::move(*result);
  }

  [[nodiscard]] const Watch& watch() const { return watch_; }
  [[nodiscard]] const std::atomic<bool>* stop() const { return &stop_; }
  /// True if it was asked to stop, other than by end_by_wish().
  [[nodiscard]] bool given_up() const { return stop_.load(std::memory_order_relaxed) && !ended_by_wish_; }
  /// Ends the work at once, in callbacks of the library, if Ctrl-C or a failed function has asked it to stop.
  void throw_if_given_up() const {
    if (given_up()) throw Interrupted();
  }
  /// Calls a Python function from whichever thread computes. The first exception of one ends the work and is raised when it has
  /// ended.
  template <class Call>
  void call(Call&& call) {
    const pybind11::gil_scoped_acquire held;
    try {
      call();
    } catch (pybind11::error_already_set&) {
      keep(std::current_exception());
    }
  }
  /// Keeps an exception that is on its way through the library, which may take it for a bad candidate.
  void keep(std::exception_ptr error);

 private:
  void finish(const std::exception_ptr& error);

  std::atomic<bool> stop_ = false, ended_by_wish_ = false;
  std::mutex lock_;
  std::exception_ptr first_;
  pybind11::object progress_;
  std::atomic<std::chrono::steady_clock::rep> told_ = 0;
  std::mutex progress_lock_;  // guards what follows
  MonotoneProgress shown_;
  Watch watch_;

 public:
  /// Ends the work by the wish of a callback: the result is then the one found so far.
  void end_by_wish() {
    ended_by_wish_ = true;
    stop_ = true;
  }
};

}  // namespace softland::python
