#include "studies/search/step_comparison.h"

#include <algorithm>
#include <cmath>

#include "sampling/confidence.h"
#include "sampling/statistics.h"

namespace softland {
namespace {

constexpr int repetitions = 400;
constexpr double compared_at = 0.95, confidence = 0.95;

std::vector<double> values_of(std::string_view key, const std::vector<DeviceOutcome>& outcomes, double least) {
  std::vector<double> all;
  for (const DeviceOutcome& o : outcomes) all.push_back(std::max(o.of(figure_of(key)), least));
  return all;
}

// True if the 95th percentile (compared_at) of a figure over devices is larger in `own` than in `of_step`; values may be
// infinite.
bool is_above(const std::vector<double>& own, const std::vector<double>& of_step) {
  return sample_quantile(own, compared_at) > sample_quantile(of_step, compared_at);
}

bool is_worse(const std::vector<double>& own, const std::vector<double>& of_step, std::uint64_t seed) {
  if (!is_above(own, of_step)) return false;
  std::size_t above = 0;
  std::vector<double> a(own.size()), b(own.size());
  for (int r = 0; r < repetitions; ++r) {
    for (std::size_t k = 0; k < own.size(); ++k) {
      const std::size_t row = internal::bootstrap_row(seed, static_cast<std::size_t>(r), k, own.size());
      a[k] = own[row], b[k] = of_step[row];
    }
    if (is_above(a, b)) ++above;
  }
  return static_cast<double>(above) > (1 - (1 - confidence) / 2) * repetitions;
}

}  // namespace

std::vector<std::string_view> worse_in(const std::vector<DeviceOutcome>& drive, const std::vector<DeviceOutcome>& step,
                                       double significant, std::uint64_t seed) {
  std::vector<std::string_view> worse;
  // An interrupted simulation has fewer outcomes: compare the devices that both lists have.
  const std::size_t both = std::min(drive.size(), step.size());
  for (const std::string_view key : judged_figures) {
    const double least = key == key_of(&Metrics::major_bounce_height) ? significant : 0;
    std::vector<double> own = values_of(key, drive, least), of_step = values_of(key, step, least);
    own.resize(both), of_step.resize(both);
    if (both > 0 && is_worse(own, of_step, seed)) worse.push_back(key);
  }
  return worse;
}

std::vector<Condition> at_most_step(const std::vector<DeviceOutcome>& step, double significant) {
  std::vector<Condition> all;
  for (const std::string_view key : judged_figures) {
    const double least = key == key_of(&Metrics::major_bounce_height) ? significant : 0;
    const double limit = sample_quantile(values_of(key, step, least), compared_at);
    if (std::isfinite(limit))
      all.push_back({.figure = figure_of(key), .comparison = Comparison::at_most, .limit = limit, .text = ""});
  }
  return all;
}

}  // namespace softland
