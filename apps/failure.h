// A failure gives the reason why a run did not succeed, as an exit status and as a message.
#pragma once

#include <exception>
#include <string>

namespace softland::apps {

struct Failure {
  int status;
  std::string message;
};

/// Returns exit status and message for an exception that ends the program. An unexpected exception is an internal error, and
/// its message asks the user to report it.
[[nodiscard]] Failure failure_of(const std::exception_ptr& exception);

}  // namespace softland::apps
