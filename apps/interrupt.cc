#include "apps/interrupt.h"

namespace softland::apps {
namespace {

std::atomic<bool> requested{false}, by_key{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_signal(int number) {
  requested = true;
  if (number != SIGINT || !by_key.exchange(true)) return;
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;  // SA_RESTART is not set: a signal then ends a write that waits because the pipe is full
  sigemptyset(&action.sa_mask);
  for (const int number : stopping_signals) {
    struct sigaction before {};
    if (sigaction(number, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
  for (const int number : {SIGPIPE, SIGXFSZ}) std::signal(number, SIG_IGN);
}

const std::atomic<bool>& stop_requested() { return requested; }

}  // namespace softland::apps
