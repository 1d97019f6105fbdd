#include "apps/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace softland::apps {

Bar::Bar(bool quiet) : terminal_(isatty(2) != 0), quiet_(quiet), start_(std::chrono::steady_clock::now()), shown_(start_) {}

void Bar::show(const State& state) {
  const auto now = std::chrono::steady_clock::now();
  if (now - shown_ < std::chrono::milliseconds(terminal_ ? 200 : 10000)) return;
  shown_ = now;
  print(state);
}

void Bar::close(const State& state) {
  if (!terminal_ || quiet_) return;
  print(state);
  fmt::print(stderr, "\n");
}

void Bar::print(const State& state) const {
  if (quiet_) return;
  const auto [part, words] = state(std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count());
  if (terminal_) {
    constexpr int cells = 24;
    const auto full = static_cast<std::size_t>(std::clamp(static_cast<int>(part * cells), 0, cells));
    fmt::print(stderr, "\r[{}{}] {}\033[K", std::string(full, '#'), std::string(cells - full, '.'), words);
  } else {
    fmt::print(stderr, "softland: {}\n", words);
  }
  std::fflush(stderr);
}

SearchProgress::SearchProgress(bool quiet, const OptimizeOptions& options)
    : bar_(quiet), budget_(options.max_evaluations), seconds_(options.max_seconds) {}

void SearchProgress::show(const OptimizeProgress& progress) {
  progress_ = progress;
  bar_.show([this](double elapsed) { return state(elapsed); });
}

void SearchProgress::close() {
  bar_.close([this](double elapsed) { return state(elapsed); });
}

std::pair<double, std::string> SearchProgress::state(double elapsed) const {
  const bool timed = std::isfinite(seconds_);
  std::string state = timed ? fmt::format("{:.0f} of {:g} s, {} evaluations", elapsed, seconds_, progress_.evaluations)
                            : fmt::format("{} of {} evaluations, {:.0f} s", progress_.evaluations, budget_, elapsed);
  state += std::isfinite(progress_.best_cost)
               ? fmt::format(", cost {:.4f} (plain step {:.4f})", progress_.best_cost, progress_.baseline_cost)
               : ", no feasible waveform yet";
  return {timed ? elapsed / seconds_ : static_cast<double>(progress_.evaluations) / static_cast<double>(budget_), state};
}

}  // namespace softland::apps
