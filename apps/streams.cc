#include "apps/streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <string>
#include <system_error>

#include "apps/interrupt.h"
#include "base/output_lost.h"
#include "base/printable.h"

namespace softland::apps {
namespace {

// Writes to standard error; a failure is ignored, so that the result is still written.
void write_to_standard_error(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // The standard stream `stream` is closed, so open() returns its number as the lowest free descriptor. A read-only
    // descriptor refuses writes.
    (void)::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

void print(std::string_view text) {
  const std::string clean = printable(text);
  // Time between two checks for a request to stop; longest wait, after that request, for a reader of standard output [ms].
  constexpr int check_interval = 200, patience = 600;
  int waited = 0;
  for (std::string_view rest = clean; !rest.empty();) {
    // A pipe that poll() reports as writable takes PIPE_BUF bytes without waiting for the reader.
    pollfd output{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
    if (const int ready = ::poll(&output, 1, check_interval); ready <= 0) {
      // Count only the waiting time after the request to stop the program; a signal ends a call of poll() early.
      if (ready == 0 && stop_requested()) waited += check_interval;
      if (waited >= patience) throw OutputInterrupted();
      continue;
    }
    waited = 0;
    const ssize_t written = ::write(STDOUT_FILENO, rest.data(), std::min<std::size_t>(rest.size(), PIPE_BUF));
    if (written < 0) {
      if (errno == EINTR || errno == EAGAIN) continue;
      throw OutputLost(fmt::format("standard output: could not be written: {}", std::generic_category().message(errno)));
    }
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
}

void print_note(std::string_view line) { write_to_standard_error("softland: " + printable_line(line) + "\n"); }

void end_bar() { write_to_standard_error("\n"); }

void show_bar(std::string_view line) { write_to_standard_error("\r" + printable_line(line) + "\033[K"); }

}  // namespace softland::apps
