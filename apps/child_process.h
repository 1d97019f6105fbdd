// A command of the user's that runs beside the program and is talked to line by line.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "apps/line_reader.h"

namespace softland::apps {

/// Runs a command by the shell, in a process group of its own, its standard input and output pipes of ours. When the object goes,
/// so does the command: its input ends, and where it does not follow, its group is told to end, and then made to.
class ChildProcess {
 public:
  /// `longest_line` [byte] is the most that is read of a line. Throws std::system_error where the system starts no process.
  ChildProcess(const std::string& command, std::size_t longest_line);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  enum class Told { yes, closed, late };
  /// Writes to its standard input: `closed` where nobody reads it any more, `late` where not all of it was taken in `patience`.
  /// Throws Interrupted where a signal asks to stop.
  [[nodiscard]] Told tell(std::string_view text, std::chrono::milliseconds patience);
  /// The next line of its standard output: see LineReader::next().
  [[nodiscard]] LineReader::Line next_line(std::chrono::milliseconds patience) { return lines_.next(patience); }
  /// How it ended, in words: "ended with status 3"; empty where it still runs after `patience`.
  [[nodiscard]] std::string ending(std::chrono::milliseconds patience);

 private:
  struct Pipes {
    int in, out;  // its standard input and output, our ends
  };
  [[nodiscard]] static Pipes start(const std::string& command, pid_t& child);
  [[nodiscard]] bool has_ended(std::chrono::milliseconds patience);
  void close_input();

  pid_t child_ = 0;
  Pipes pipes_;
  LineReader lines_;
  std::optional<int> status_;  // as wait() tells it
};

}  // namespace softland::apps
