#include "apps/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "apps/streams.h"

namespace softland::apps {

Bar::Bar(bool quiet) : terminal_(isatty(2) != 0), quiet_(quiet), start_(std::chrono::steady_clock::now()), shown_(start_) {}

bool Bar::due() const {
  const bool is_first = shown_ == start_;
  // Shortest time between two updates of the displayed progress [ms].
  const int wait = terminal_ ? 200 : is_first ? 5000 : 10000;
  return !quiet_ && std::chrono::steady_clock::now() - shown_ >= std::chrono::milliseconds(wait);
}

void Bar::show(const State& state) {
  if (!due()) return;
  shown_ = std::chrono::steady_clock::now();
  print(state);
}

void Bar::close(const State& state) {
  if (!terminal_ || quiet_) return;
  print(state);
  end_bar();
}

double Bar::elapsed() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

void Bar::print(const State& state) const {
  if (quiet_) return;
  const auto [part, words] = state(elapsed());
  if (terminal_) {
    constexpr int cells = 24;
    const auto full = static_cast<std::size_t>(std::clamp(static_cast<int>(part * cells), 0, cells));
    show_bar(fmt::format("[{}{}] {}", std::string(full, '#'), std::string(cells - full, '.'), words));
  } else {
    print_note(words);
  }
}

ShownWork::ShownWork(bool quiet, const std::atomic<bool>* stop) : bar_(quiet) {
  progress_.stop = stop;
  progress_.report = [this](std::string_view told_of, double told_part) {
    const std::scoped_lock lock(mutex_);
    const auto [what, part] = monotone_.updated(told_of, told_part);
    pace_.note(what, part, bar_.elapsed());
    if (!bar_.due()) return;
    const double done = part;
    bar_.show([&](double elapsed) { return std::pair(done, pace_.words(elapsed)); });
    shown_ = true;
  };
}

ShownWork::~ShownWork() {
  if (shown_ && bar_.terminal_) show_bar("");
}

SearchProgress::SearchProgress(bool quiet, const OptimizeOptions& options, std::string counted, std::string of)
    : bar_(quiet),
      budget_(options.max_evaluations),
      seconds_(options.max_seconds),
      counted_(std::move(counted)),
      of_(std::move(of)) {}

void SearchProgress::show(const OptimizeProgress& progress) {
  progress_ = progress;
  if (progress.planned > 0) budget_ = progress.planned;
  bar_.show([this](double elapsed) {
    pace_.note(of_, static_cast<double>(progress_.evaluations) / static_cast<double>(budget_), elapsed);
    return state(elapsed);
  });
}

void SearchProgress::close() {
  bar_.close([this](double elapsed) { return state(elapsed); });
}

std::pair<double, std::string> SearchProgress::state(double elapsed) const {
  const bool timed = std::isfinite(seconds_);
  std::string state = of_;
  state += timed ? fmt::format("{:.0f} of {:g} s, {} {}", elapsed, seconds_, progress_.evaluations, counted_)
                 : fmt::format("{} of {} {}, {:.0f} s", progress_.evaluations, budget_, counted_, elapsed);
  if (const std::optional<double> left = pace_.seconds_left(elapsed); left && !timed)
    state += fmt::format(", about {:.0f} s left", *left);
  state += std::isfinite(progress_.best_cost)
               ? fmt::format(", cost {:.4f} (plain step {:.4f})", progress_.best_cost, progress_.baseline_cost)
               : ", no feasible waveform yet";
  return {timed ? elapsed / seconds_ : static_cast<double>(progress_.evaluations) / static_cast<double>(budget_), state};
}

}  // namespace softland::apps
