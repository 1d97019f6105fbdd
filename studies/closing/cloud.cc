#include "studies/closing/cloud.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/executor.h"
#include "base/random.h"
#include "objectives/figure_values.h"

namespace softland {

std::vector<Trajectory> perturbed_closings(const Switch& model, std::span<const Signal> drives, const ClosingOptions& closing,
                                           const CloudOptions& options, const Progress& progress) {
  std::vector<Trajectory> runs(static_cast<std::size_t>(options.runs));
  std::mutex telling;
  int done = 0;
  const auto run = [&](std::size_t i) {
    std::uint64_t counter = 2 * drives.size() * i;
    std::vector<Signal> perturbed;
    for (const Signal& drive : drives) {
      const double size = random_uniform(options.seed, Stream::perturbation, counter++);
      const double sign = random_uniform(options.seed, Stream::perturbation, counter++);
      const double change = options.smallest * std::pow(options.largest / options.smallest, size);
      perturbed.push_back(scaled(drive, 1 + (sign < 0.5 ? -change : change)));
    }
    runs[i] = simulate_closing(model, perturbed, closing);
    const std::scoped_lock lock(telling);
    progress.tell("cloud of perturbed closings", static_cast<double>(++done) / options.runs);
  };
  runs.resize(run_tasks(runs.size(), options.jobs, run, closing.stop));
  const auto interrupted = [](const Trajectory& t) { return t.status == Status::interrupted; };
  runs.erase(std::find_if(runs.begin(), runs.end(), interrupted), runs.end());
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

bool ill_conditioned(const Spread& values) { return relative_difference(values.high, values.low) > ill_conditioned_range; }

}  // namespace softland
