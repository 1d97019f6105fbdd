// Bytes of a file as UTF-8 text: what byte order marks say, UTF-16 with or without one, and line ends of all systems.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace softland::internal {

/// The content as UTF-8, without a byte order mark. UTF-16 is known by its mark, or by every other byte of its beginning being
/// zero. `storage` holds the text where it is not the content itself; `left_out` names what cannot be decoded.
[[nodiscard]] std::string_view decoded(std::string_view content, std::string& storage, std::vector<std::string>& left_out);

/// True if a text holds bytes that no text has.
[[nodiscard]] bool is_binary(std::string_view text);

/// The lines of a text, which end with LF, CR LF or CR.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  /// True if there was one more line; it is then in line() and has number().
  bool next();
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::size_t number() const { return number_; }
  /// True if the line ended with the file instead of a line end.
  [[nodiscard]] bool is_unended() const { return is_unended_; }

 private:
  std::string_view rest_, line_;
  std::size_t number_ = 0;
  bool is_unended_ = false;
};

}  // namespace softland::internal
