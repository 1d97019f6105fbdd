// The exception for results that could not be written.
#pragma once

#include <stdexcept>

namespace softland {

/// Thrown when part of the output could not be written: the disk is full, the pipe closed, the limit of a file's size reached.
/// The message names file and reason. The program turns this exception into a separate exit status.
class OutputLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace softland
