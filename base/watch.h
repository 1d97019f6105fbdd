// Lets the outside watch a long computation: it can be asked to stop, and it reports its progress.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <string_view>

namespace softland {

/// Thrown when a computation was asked to stop before it had anything to return. The program turns it into exit status 130.
class Interrupted : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

struct Watch {
  const std::atomic<bool>* stop = nullptr;  ///< set from outside (Ctrl-C); the computation ends with its result so far
  /// Called often, from the threads that compute, one at a time, with the name of the computation and its completed part, 0 to
  /// 1.
  std::function<void(std::string_view what, double part)> progress = {};

  [[nodiscard]] bool stopped() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
  void throw_if_stopped() const {
    if (stopped()) throw Interrupted();
  }
  void tell(std::string_view what, double part) const {
    if (progress) progress(what, part);
  }
};

}  // namespace softland
