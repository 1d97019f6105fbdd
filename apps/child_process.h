// A child process is a command of the user's that runs beside the program; both exchange lines.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "apps/line_reader.h"

namespace softland::apps {

/// Runs a command by the shell, in a process group of its own, with pipes for its standard input and output. The destructor
/// ends the command: its input ends; if it does not follow, its group is asked to end, and then forced to.
class ChildProcess {
 public:
  /// `longest_line` [byte] is the most that is read of a line. Throws std::system_error where the system starts no process.
  ChildProcess(const std::string& command, std::size_t longest_line);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  enum class Told { yes, closed, late };
  /// Writes to its standard input: `closed` where the pipe has no reader any more, `late` where the text was not taken in
  /// `patience`. Throws Interrupted where a signal asks to stop.
  [[nodiscard]] Told tell(std::string_view text, std::chrono::milliseconds patience);
  /// Reads the next line of its standard output: see LineReader::next().
  [[nodiscard]] LineReader::Line next_line(std::chrono::milliseconds patience) { return lines_.next(patience); }
  /// Says how it ended: "ended with status 3"; empty where it still runs after `patience`.
  [[nodiscard]] std::string ending(std::chrono::milliseconds patience);

 private:
  struct Pipes {
    int in, out;  // our ends of its standard input and output
  };
  [[nodiscard]] static Pipes start(const std::string& command, pid_t& child);
  [[nodiscard]] bool has_ended(std::chrono::milliseconds patience);
  void close_input();

  pid_t child_ = 0;
  Pipes pipes_;
  LineReader lines_;
  std::optional<int> status_;  // status of wait()
};

}  // namespace softland::apps
