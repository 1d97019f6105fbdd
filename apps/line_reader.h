// Reads lines of text from a pipe or a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace softland::apps {

class LineReader {
 public:
  /// Reads from a file descriptor, which stays open. A line of more than `longest` bytes is cut to `longest` + 1 bytes, which
  /// marks the line as too long; the rest of the line is skipped.
  explicit LineReader(int descriptor, std::size_t longest);

  enum class End { line, closed, late };
  struct Line {
    End end = End::closed;
    std::string text = {};  ///< text of the line, without its line feed
  };
  /// Returns the next line; the last line may lack its line feed. Returns `late` if no line came within `patience`; without
  /// `patience`, waits without limit. Throws Interrupted after a signal to stop.
  [[nodiscard]] Line next(std::optional<std::chrono::milliseconds> patience = {});

 private:
  [[nodiscard]] std::optional<std::string> complete_line();
  [[nodiscard]] bool fill();  // reads more bytes; returns false at the end of the input

  int descriptor_;
  std::size_t longest_;
  std::string read_;
  std::size_t searched_ = 0;  // length of the beginning of read_ that is known to have no line feed
  bool ended_ = false;
};

}  // namespace softland::apps
