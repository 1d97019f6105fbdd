// A child process runs a command of the user; program and command exchange lines of text.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "apps/line_reader.h"

namespace softland::apps {

/// Runs a command in the shell, in its own process group, with pipes for its standard input and output. The destructor closes
/// the input of the command, and sends SIGTERM and later SIGKILL to the process group if the command has not ended soon after
/// that.
class ChildProcess {
 public:
  /// Starts the command. Lines of its output are cut beyond `longest_line` [byte]. Throws std::system_error if no process
  /// starts.
  ChildProcess(const std::string& command, std::size_t longest_line);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  enum class Delivery { yes, closed, late };
  /// Writes to the standard input of the command. Returns `closed` if the command has closed the pipe, and `late` if it did not
  /// read the text within `patience`. Throws Interrupted after a signal to stop.
  [[nodiscard]] Delivery tell(std::string_view text, std::chrono::milliseconds patience);
  /// Reads the next line from the standard output of the command, as LineReader::next() does.
  [[nodiscard]] LineReader::Line next_line(std::chrono::milliseconds patience) { return lines_.next(patience); }
  /// Returns how the command ended, such as "ended with status 3"; empty if it still runs after `patience`.
  [[nodiscard]] std::string ending(std::chrono::milliseconds patience);

 private:
  struct Pipes {
    int in, out;  // this program's ends of the pipes to the standard input and output of the command
  };
  [[nodiscard]] static Pipes start(const std::string& command, pid_t& child);
  [[nodiscard]] bool has_ended(std::chrono::milliseconds patience);
  void close_input();

  pid_t child_ = 0;
  Pipes pipes_;
  LineReader lines_;
  std::optional<int> status_;  // exit status of the command as waitpid() gives it; none while the command runs
};

}  // namespace softland::apps
