#include "apps/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>

#include "apps/interrupt.h"
#include "base/progress.h"

extern char** environ;

namespace softland::apps {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

void require_done(int error, const char* what) {
  if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

// Creates a pipe whose ends are closed in every child process, except for an end that a child gets as its standard stream.
std::array<int, 2> new_pipe() {
  std::array<int, 2> ends{};
  require_done(::pipe2(ends.data(), O_CLOEXEC) == 0 ? 0 : errno, "a pipe to a command");
  return ends;
}

// Attributes for posix_spawn(): the command gets its own process group and the default action for every signal, also for
// signals that this program ignores or blocks.
class SpawnAttributes {
 public:
  SpawnAttributes() {
    posix_spawnattr_init(&attributes_);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  [[nodiscard]] const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

}  // namespace

ChildProcess::Pipes ChildProcess::start(const std::string& command, pid_t& child) {
  const std::array<int, 2> in = new_pipe(), out = new_pipe();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  std::string shell = "sh", option = "-c", words = command;
  const std::array<char*, 4> arguments{shell.data(), option.data(), words.data(), nullptr};
  const SpawnAttributes attributes;
  const int error = ::posix_spawn(&child, "/bin/sh", &actions, attributes.get(), arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(in[0]);
  ::close(out[1]);
  if (error != 0) {
    ::close(in[1]);
    ::close(out[0]);
  }
  require_done(error, "starting a command");
  ::fcntl(in[1], F_SETFL, O_NONBLOCK);
  return {.in = in[1], .out = out[0]};
}

ChildProcess::ChildProcess(const std::string& command, std::size_t longest_line)
    : pipes_(start(command, child_)), lines_(pipes_.out, longest_line) {}

ChildProcess::~ChildProcess() {
  constexpr milliseconds own_end{500}, told_end{1000};
  close_input();
  if (!has_ended(own_end)) {
    ::kill(-child_, SIGTERM);
    if (!has_ended(told_end)) {
      ::kill(-child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
  }
  ::close(pipes_.out);
}

void ChildProcess::close_input() {
  if (pipes_.in >= 0) ::close(pipes_.in);
  pipes_.in = -1;
}

ChildProcess::Delivery ChildProcess::tell(std::string_view text, milliseconds patience) {
  constexpr milliseconds check_interval{200};
  const steady_clock::time_point end = steady_clock::now() + patience;
  while (!text.empty()) {
    if (stop_requested()) throw Interrupted();
    const ssize_t written = ::write(pipes_.in, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
      continue;
    }
    if (errno != EAGAIN && errno != EINTR) return Delivery::closed;
    const auto left = std::chrono::duration_cast<milliseconds>(end - steady_clock::now());
    if (left.count() <= 0) return Delivery::late;
    pollfd input{.fd = pipes_.in, .events = POLLOUT, .revents = 0};
    ::poll(&input, 1, static_cast<int>(std::min(left, check_interval).count()));
  }
  return Delivery::yes;
}

bool ChildProcess::has_ended(milliseconds patience) {
  constexpr milliseconds pause{5};
  const steady_clock::time_point end = steady_clock::now() + patience;
  while (!status_) {
    int status = 0;
    if (::waitpid(child_, &status, WNOHANG) == child_) {
      status_ = status;
    } else if (steady_clock::now() >= end) {
      return false;
    } else {
      std::this_thread::sleep_for(pause);
    }
  }
  return true;
}

std::string ChildProcess::ending(milliseconds patience) {
  if (!has_ended(patience)) return {};
  if (WIFSIGNALED(*status_)) return fmt::format("was ended by signal {}", WTERMSIG(*status_));
  return fmt::format("ended with status {}", WEXITSTATUS(*status_));
}

}  // namespace softland::apps
