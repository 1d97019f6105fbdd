// Results that could not be written.
#pragma once

#include <stdexcept>

namespace softland {

/// Thrown when part of the output did not reach its place: the disk is full, the pipe closed, the limit of a file's size
/// reached. The message names place and reason. The program turns it into a separate exit status.
class OutputLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace softland
