// Converts the bytes of a file to UTF-8 text, from UTF-8 or UTF-16 with or without a byte order mark, and splits it into lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace softland::internal {

/// Returns the content of a file as UTF-8, without a byte order mark. UTF-16 is recognised by its byte order mark, or by zeros
/// in every other byte at its beginning. `storage` holds converted text; a description of what cannot be decoded is added to
/// `left_out`.
[[nodiscard]] std::string_view decoded(std::string_view content, std::string& storage, std::vector<std::string>& left_out);

/// Returns true if the bytes are binary data, not text.
[[nodiscard]] bool is_binary(std::string_view text);

/// The lines of a text, which end with LF, CR LF or CR.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  /// Reads the next line into line() and number(); returns false at the end of the text.
  bool next();
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::size_t number() const { return number_; }
  /// Returns true if the current line is the last and has no line end.
  [[nodiscard]] bool is_unended() const { return is_unended_; }

 private:
  std::string_view rest_, line_;
  std::size_t number_ = 0;
  bool is_unended_ = false;
};

}  // namespace softland::internal
