#include "studies/closing/timing.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "model/closing.h"
#include "objectives/metrics.h"

namespace softland {

namespace {

std::size_t size_of_state(const Switch& model) { return 2 * static_cast<std::size_t>(model.modes()) + model.film_states(); }

}  // namespace

void keep_state(const Switch& model, const double* q, std::vector<double>& states) {
  constexpr std::size_t most = 20'000;
  const std::size_t size = size_of_state(model);
  if (states.size() < most * size) states.insert(states.end(), q, q + size);
}

double right_hand_side_seconds(const Switch& model, const std::vector<Signal>& signals, double duration, int repeats) {
  std::vector<double> states;
  ClosingOptions options{.duration = duration, .tolerance = 1e-6};
  options.observer = [&](double, const double* q, const double*) {
    const std::size_t before = states.size();
    keep_state(model, q, states);
    return states.size() == before;
  };
  (void)simulate_closing(model, signals, options);
  return right_hand_side_seconds(model, hold_levels(signals), states, repeats);
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double right_hand_side_seconds(const Switch& model, const std::vector<double>& volts, const std::vector<double>& states,
                               int repeats) {
  using Clock = std::chrono::steady_clock;
  const std::size_t size = size_of_state(model);
  const std::size_t count = states.size() / size;
  if (count == 0) return Metrics::unset;
  std::vector<char> touching(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double* q = &states[size * i];
    touching[i] = model.has_contact() && (model.contact_deflection(q) > model.contact_gap() || model.untouched(q).active);
  }
  Switch::Workspace work = model.workspace();
  std::vector<double> result(size), times;
  double sum = 0;
  for (int r = 0; r < repeats; ++r) {
    const auto start = Clock::now();
    for (std::size_t i = 0; i < count; ++i) {
      model.rates(&states[size * i], volts, touching[i] != 0, work, result.data());
      sum += result[0];
    }
    times.push_back(std::chrono::duration<double>(Clock::now() - start).count() / static_cast<double>(count));
  }
  const auto middle = times.begin() + repeats / 2;
  std::nth_element(times.begin(), middle, times.end());
  return std::isfinite(sum) ? *middle : Metrics::unset;  // the use of `sum` keeps the compiler from removing the timed loop
}

}  // namespace softland
