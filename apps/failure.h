// Maps an exception that ends the program to an exit status and a message.
#pragma once

#include <exception>
#include <string>

namespace softland::apps {

struct Failure {
  int status;
  std::string message;
};

/// Returns exit status and message for an exception that ends the program. An exception of an unexpected type is an internal
/// error; the message then asks the user to report the error.
[[nodiscard]] Failure failure_of(const std::exception_ptr& exception);

}  // namespace softland::apps
