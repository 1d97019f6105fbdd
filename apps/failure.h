// A failure says why a run did not succeed, as the exit status and in words.
#pragma once

#include <exception>
#include <string>

namespace softland::apps {

struct Failure {
  int status;
  std::string message;
};

/// Returns the meaning of an exception that ends the program: every kind has its exit status. An unexpected one is a fault of
/// the program that asks to be reported.
[[nodiscard]] Failure failure_of(const std::exception_ptr& exception);

}  // namespace softland::apps
