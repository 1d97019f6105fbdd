// Lets the caller of a long computation stop the computation and follow its progress.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <string_view>

namespace softland {

/// Thrown when a computation is stopped before it has a result. The program turns this exception into exit status 130.
class Interrupted : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

struct Progress {
  /// Flag that another thread sets (Ctrl-C) to stop the computation, which then ends with its result so far.
  const std::atomic<bool>* stop = nullptr;
  /// Function that is called often, from the threads that compute, one at a time, with the name of the computation and its
  /// completed part, 0 to 1.
  std::function<void(std::string_view what, double part)> report = {};

  [[nodiscard]] bool stopped() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
  void throw_if_stopped() const {
    if (stopped()) throw Interrupted();
  }
  void tell(std::string_view what, double part) const {
    if (report) report(what, part);
  }
};

}  // namespace softland
