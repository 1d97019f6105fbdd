#include "studies/closing/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "model/closing.h"
#include "objectives/metrics.h"

namespace softland {

double right_hand_side_seconds(const Switch& model, const std::vector<Signal>& signals, double duration, int repeats) {
  using Clock = std::chrono::steady_clock;
  const auto n = static_cast<std::size_t>(model.modes());
  const std::size_t size = 2 * n + model.film_states();
  std::vector<double> states;  // q, v and what follows them, one after the other
  ClosingOptions options{.duration = duration, .tolerance = 1e-6};
  options.observer = [&](double, const double* q, const double*) {
    states.insert(states.end(), q, q + size);
    return false;
  };
  (void)simulate_closing(model, signals, options);
  const std::size_t count = states.size() / size;
  if (count == 0) return Metrics::unset;
  std::vector<char> touching(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double* q = &states[size * i];
    touching[i] = model.has_contact() && (model.contact_deflection(q) > model.contact_gap() || model.untouched(q).active);
  }
  const std::vector<double> volts = hold_levels(signals);
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
  return std::isfinite(sum) ? *middle : Metrics::unset;  // the sum also keeps the loop alive
}

}  // namespace softland
