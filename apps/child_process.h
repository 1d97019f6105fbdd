// A child process runs a command of the user; program and command exchange lines of text.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "apps/line_reader.h"

namespace softland::apps {

/// Runs a command by the shell, in a process group of its own, with pipes for its standard input and output. The destructor
/// closes the input of the command. If the command then does not end, its group receives SIGTERM, and later SIGKILL.
class ChildProcess {
 public:
  /// Starts the command. A line longer than `longest_line` [byte] is cut. Throws std::system_error if no process can be started.
  ChildProcess(const std::string& command, std::size_t longest_line);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  enum class Delivery { yes, closed, late };
  /// Writes to the standard input of the command. Returns `closed` if the pipe has no reader, and `late` if the command did not
  /// read the text within `patience`. Throws Interrupted after a signal to stop.
  [[nodiscard]] Delivery tell(std::string_view text, std::chrono::milliseconds patience);
  /// Reads the next line from the standard output of the command, as LineReader::next() does.
  [[nodiscard]] LineReader::Line next_line(std::chrono::milliseconds patience) { return lines_.next(patience); }
  /// Returns how the command ended, such as "ended with status 3"; empty if it still runs after `patience`.
  [[nodiscard]] std::string ending(std::chrono::milliseconds patience);

 private:
  struct Pipes {
    int in, out;  // our ends of the pipes to the standard input and output of the command
  };
  [[nodiscard]] static Pipes start(const std::string& command, pid_t& child);
  [[nodiscard]] bool has_ended(std::chrono::milliseconds patience);
  void close_input();

  pid_t child_ = 0;
  Pipes pipes_;
  LineReader lines_;
  std::optional<int> status_;  // exit status as wait() gives it
};

}  // namespace softland::apps
