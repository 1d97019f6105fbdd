#include "sampling/statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string>

#include "base/engineering.h"
#include "base/require.h"

namespace softland {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

bool all_finite(std::span<const double> sample) {
  return std::all_of(sample.begin(), sample.end(), [](double x) { return std::isfinite(x); });
}

// Returns the central moment of a sample, the mean of (x - mean)^order.
double central_moment(std::span<const double> sample, double mean, int order) {
  double sum = 0;
  for (const double x : sample) sum += std::pow(x - mean, order);
  return sum / static_cast<double>(sample.size());
}

}  // namespace

double sample_mean(std::span<const double> sample) {
  internal::check_sample(sample);
  return std::accumulate(sample.begin(), sample.end(), 0.0) / static_cast<double>(sample.size());
}

double sample_standard_deviation(std::span<const double> sample) {
  const double n = static_cast<double>(sample.size()), mean = sample_mean(sample);
  if (sample.size() < 2) return unknown;
  if (!all_finite(sample)) return infinite;
  return std::sqrt(central_moment(sample, mean, 2) * n / (n - 1));
}

double sample_skewness(std::span<const double> sample) {
  const double n = static_cast<double>(sample.size()), mean = sample_mean(sample);
  if (sample.size() < 3 || !all_finite(sample) || std::equal(sample.begin() + 1, sample.end(), sample.begin())) return unknown;
  const double variance = central_moment(sample, mean, 2);
  return std::sqrt(n * (n - 1)) / (n - 2) * central_moment(sample, mean, 3) / (variance * std::sqrt(variance));
}

double sample_quantile(std::span<const double> sample, double p) {
  internal::check_sample(sample);
  require(0 <= p && p <= 1, "p = " + engineering(p, "") + " must be between 0 and 1");
  std::vector<double> sorted(sample.begin(), sample.end());
  std::sort(sorted.begin(), sorted.end());
  return internal::quantile_of_sorted(sorted, p);
}

void internal::check_sample(std::span<const double> sample) {
  require(!sample.empty(), "a sample must have at least one value");
  const bool ordered = std::all_of(sample.begin(), sample.end(), [](double x) { return x > -infinite; });
  require(ordered, "a sample must hold neither NaN nor -infinity");
}

double internal::quantile_of_sorted(std::span<const double> sorted, double p) {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const std::size_t j = std::min(static_cast<std::size_t>(place), sorted.size() - 1);
  const double fraction = place - static_cast<double>(j);
  // Return the value x_j itself where the interpolation below would give NaN: 0 times infinity, or infinity minus infinity.
  if (fraction == 0 || std::isinf(sorted[j])) return sorted[j];
  const double step = sorted[j + 1] - sorted[j];
  if (std::isinf(step)) return (1 - fraction) * sorted[j] + fraction * sorted[j + 1];
  return sorted[j] + fraction * step;
}

double conditional_value_at_risk(std::span<const double> sample, double alpha) {
  internal::check_sample(sample);
  require(0 <= alpha && alpha < 1, "alpha = " + engineering(alpha, "") + " must be at least 0 and below 1");
  std::vector<double> worst(sample.begin(), sample.end());
  std::sort(worst.begin(), worst.end(), std::greater<>());
  const double m = (1 - alpha) * static_cast<double>(sample.size());
  const std::size_t whole = std::min(static_cast<std::size_t>(m), sample.size());
  const double fraction = m - static_cast<double>(whole);
  double sum = std::accumulate(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(whole), 0.0);
  if (fraction > 0 && whole < worst.size()) sum += fraction * worst[whole];
  return sum / m;
}

Histogram histogram(std::span<const double> sample, std::size_t most_bins) {
  internal::check_sample(sample);
  require(most_bins >= 1, "most_bins = 0 must be at least 1");
  std::vector<double> finite;
  std::copy_if(sample.begin(), sample.end(), std::back_inserter(finite), [](double x) { return std::isfinite(x); });
  Histogram made{.infinite = sample.size() - finite.size()};
  if (finite.empty()) return made;
  std::sort(finite.begin(), finite.end());
  made.low = finite.front();
  made.high = finite.back();
  const double n = static_cast<double>(finite.size()), range = made.high - made.low;
  const double spread = internal::quantile_of_sorted(finite, 0.75) - internal::quantile_of_sorted(finite, 0.25);
  double bins = 1;
  if (range > 0) bins = std::ceil(spread > 0 ? range * std::cbrt(n) / (2 * spread) : 1 + std::log2(n));
  if (!std::isfinite(bins)) bins = static_cast<double>(most_bins);
  made.counts.resize(static_cast<std::size_t>(std::clamp(bins, 1.0, static_cast<double>(most_bins))));
  for (const double x : finite) {
    // If high - low overflows, compute the position in the range from a quarter of each number.
    const double part = std::isfinite(range) ? (x - made.low) / range : (x / 4 - made.low / 4) / (made.high / 4 - made.low / 4);
    const double place = range > 0 ? part * static_cast<double>(made.counts.size()) : 0;
    ++made.counts[std::min(static_cast<std::size_t>(place), made.counts.size() - 1)];
  }
  return made;
}

}  // namespace softland
