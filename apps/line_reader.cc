#include "apps/line_reader.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "apps/interrupt.h"
#include "base/progress.h"

namespace softland::apps {

LineReader::LineReader(int descriptor, std::size_t longest) : descriptor_(descriptor), longest_(longest) {}

std::optional<std::string> LineReader::complete_line() {
  const std::size_t end = read_.find('\n', searched_);
  if (end == std::string::npos) {
    searched_ = read_.size();
    return std::nullopt;
  }
  std::string line = read_.substr(0, end);
  read_.erase(0, end + 1);
  searched_ = 0;
  return line;
}

bool LineReader::fill() {
  std::array<char, 1 << 16> block{};
  const ssize_t size = ::read(descriptor_, block.data(), block.size());
  if (size < 0) return errno == EINTR || errno == EAGAIN;
  if (size == 0) return false;
  read_.append(block.data(), static_cast<std::size_t>(size));
  // Keep one byte more than the longest permitted line: the extra byte marks the line as too long.
  if (read_.size() > longest_ && read_.find('\n', searched_) == std::string::npos) read_.resize(longest_ + 1);
  return true;
}

LineReader::Line LineReader::next(std::optional<std::chrono::milliseconds> patience) {
  using std::chrono::steady_clock;
  constexpr std::chrono::milliseconds check_interval{200};
  const steady_clock::time_point begin = steady_clock::now();
  for (;;) {
    if (std::optional<std::string> line = complete_line()) return {.end = End::line, .text = *std::move(line)};
    if (ended_) break;
    if (stop_requested()) throw Interrupted();
    std::chrono::milliseconds wait = check_interval;
    if (patience) {
      const auto left = *patience - std::chrono::duration_cast<std::chrono::milliseconds>(steady_clock::now() - begin);
      if (left.count() <= 0) return {.end = End::late};
      wait = std::min(wait, left);
    }
    pollfd input{.fd = descriptor_, .events = POLLIN, .revents = 0};
    if (::poll(&input, 1, static_cast<int>(wait.count())) > 0) ended_ = !fill();
  }
  if (read_.empty()) return {.end = End::closed};
  return {.end = End::line, .text = std::exchange(read_, {})};
}

}  // namespace softland::apps
