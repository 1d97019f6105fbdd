// Lines of text come through a pipe or from a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace softland::apps {

class LineReader {
 public:
  /// Reads from a descriptor, which stays open. A line of more than `longest` bytes is cut there, so that its reader refuses
  /// it; the rest of the line is skipped.
  explicit LineReader(int descriptor, std::size_t longest);

  enum class End { line, closed, late };
  struct Line {
    End end = End::closed;
    std::string text = {};  ///< text without the line feed
  };
  /// Returns the next line; the last one may lack its line feed. `late` when none has come in `patience`; without `patience` it
  /// waits for ever. Throws Interrupted where a signal asks to stop.
  [[nodiscard]] Line next(std::optional<std::chrono::milliseconds> patience = {});

 private:
  [[nodiscard]] std::optional<std::string> complete_line();
  [[nodiscard]] bool fill();  // returns false at the end

  int descriptor_;
  std::size_t longest_;
  std::string read_;
  std::size_t searched_ = 0;  // length of the part of read_ that has no line feed
  bool ended_ = false;
};

}  // namespace softland::apps
