#include "studies/cloud.h"

#include <algorithm>
#include <cmath>

#include "optimizers/seeding.h"

namespace softland {

std::vector<Trajectory> perturbed_closings(const Switch& device, std::span<const Signal> drives, const ClosingOptions& closing,
                                           const CloudOptions& options, const Watch& watch) {
  std::vector<Trajectory> runs;
  std::uint64_t sample = 0;
  for (int i = 0; i < options.runs; ++i) {
    watch.tell("cloud of perturbed closings", static_cast<double>(i) / options.runs);
    std::vector<Signal> perturbed;
    for (const Signal& drive : drives) {
      const double size = internal::draw_uniform(options.seed, internal::Draw::perturbation, sample++);
      const double sign = internal::draw_uniform(options.seed, internal::Draw::perturbation, sample++);
      const double change = options.smallest * std::pow(options.largest / options.smallest, size);
      perturbed.push_back(scaled(drive, 1 + (sign < 0.5 ? -change : change)));
    }
    Trajectory run = simulate_closing(device, perturbed, closing);
    if (run.status == Status::interrupted) break;
    runs.push_back(std::move(run));
  }
  return runs;
}

Spread spread(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {.low = values.front(),
          .median = (values[(n - 1) / 2] + values[n / 2]) / 2,
          .high = values.back(),
          .runs = static_cast<int>(n)};
}

}  // namespace softland
