#include "python/run.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>

namespace softland::python {

namespace py = pybind11;

namespace {

constexpr int most_nested = 32;
std::array<std::atomic<std::atomic<bool>*>, most_nested> running{};
// Number of entries of `running` in use: a Python callback of one computation may start another. Only the main thread uses it.
int depth = 0;
struct sigaction before {};

bool in_main_thread() { return ::getpid() == static_cast<pid_t>(::syscall(SYS_gettid)); }

void on_interrupt(int signal, siginfo_t* info, void* context) {
  for (const auto& one : running) {
    if (std::atomic<bool>* stop = one.load()) stop->store(true);
  }
  if ((before.sa_flags & SA_SIGINFO) != 0) {
    before.sa_sigaction(signal, info, context);
  } else if (before.sa_handler != SIG_IGN && before.sa_handler != SIG_DFL) {
    before.sa_handler(signal);
  }
}

}  // namespace

StoppedByInterrupt::StoppedByInterrupt(std::atomic<bool>& stop) {
  if (!in_main_thread() || depth == most_nested) return;
  place_ = depth++;
  running[static_cast<std::size_t>(place_)] = &stop;
  if (place_ > 0) return;
  struct sigaction ours {};
  ours.sa_sigaction = on_interrupt;
  ours.sa_flags = SA_SIGINFO | SA_RESTART | SA_ONSTACK;
  ::sigemptyset(&ours.sa_mask);
  ::sigaction(SIGINT, nullptr, &before);
  ::sigaction(SIGINT, &ours, nullptr);
}

StoppedByInterrupt::~StoppedByInterrupt() {
  if (place_ < 0) return;
  if (place_ == 0) ::sigaction(SIGINT, &before, nullptr);
  running[static_cast<std::size_t>(place_)] = nullptr;
  --depth;
}

InterruptibleRun::InterruptibleRun(py::object on_progress) : on_progress_(std::move(on_progress)) {
  progress_.stop = &stop_;
  if (on_progress_.is_none()) return;
  progress_.report = [this](std::string_view told_of, double told_part) {
    using namespace std::chrono;
    const auto [what, part] = [&] {
      const std::scoped_lock lock(progress_lock_);
      return shown_.updated(told_of, told_part);
    }();
    constexpr auto least = milliseconds(100);
    const auto now = steady_clock::now().time_since_epoch();
    auto noted = last_noted_.load(std::memory_order_relaxed);
    if (given_up() || (now - steady_clock::duration(noted) < least && part < 1) ||
        !last_noted_.compare_exchange_strong(noted, now.count()))
      return;
    call([&, name = what, done = part] { on_progress_(py::str(name), done); });
  };
}

void InterruptibleRun::keep(std::exception_ptr error) {
  const std::scoped_lock lock(lock_);
  if (!first_) first_ = std::move(error);
  stop_ = true;
}

void InterruptibleRun::finish(const std::exception_ptr& error) {
  if (first_) std::rethrow_exception(first_);
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!error) return;
  try {
    std::rethrow_exception(error);
  } catch (const Interrupted&) {
    PyErr_SetString(PyExc_KeyboardInterrupt, "interrupted");
    throw py::error_already_set();
  }
}

}  // namespace softland::python
