// Confidence intervals of statistics (such as a quantile) of a distribution, from a sample of independent values. Larger values
// are worse, and +infinity is the value of a failed device (statistics.h).
//
// An interval of confidence c covers the true value of the statistic in a share c of all samples. The true value is below the
// interval in a share (1 - c) / 2 of all samples, and above it in the same share. Scrambled Sobol' points and Latin hypercubes
// are not independent samples: for means over such points these intervals are too wide.
//
// Every function throws InvalidInput unless 0 < confidence < 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "sampling/interval.h"

namespace softland {

/// Returns Wilson's score interval of a probability after `successes` in `trials`: all p with
///
///   |s/n - p| <= z sqrt(p (1 - p) / n),   z = Phi^-1((1 + confidence) / 2)
///
/// The interval is never empty and always within [0, 1], even when no trial or every trial succeeds. Its confidence holds on
/// average over p; near 0 and 1 it can be less. Returns [0, 1] without trials. Throws InvalidInput for more successes than
/// trials. Source: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209; L. D. Brown, T. T. Cai & A. DasGupta, Statistical Science
/// 16 (2001) 101.
[[nodiscard]] Interval wilson_interval(std::size_t successes, std::size_t trials, double confidence = 0.95);

/// Returns an interval of the quantile p of any distribution: between the order statistics x_l and x_u,
///
///   l = largest with P(B < l) <= (1 - confidence) / 2,   u = smallest with P(B >= u) <= (1 - confidence) / 2
///
/// B is binomial (n, p). The interval covers the quantile with at least this confidence. Its low end is -infinity, or its high
/// end +infinity, when the sample is too small. The high end is +infinity as well when x_u is the value of a failed device.
/// Throws what sample_quantile throws, and InvalidInput unless 0 < p < 1. Source: H. A. David & H. N. Nagaraja, "Order
/// Statistics", 3rd ed. 2003, section 7.1.
[[nodiscard]] Interval quantile_interval(std::span<const double> sample, double p, double confidence = 0.95);

struct BootstrapOptions {
  double confidence = 0.95;
  int repetitions = 1000;
  std::uint64_t seed = 1;
};

/// Returns a bootstrap confidence interval of a statistic (a function of a sample): quantiles of the statistic over samples
/// that are drawn from this sample with replacement. The error of its coverage falls as n^-1/2 for each side and as n^-1 for
/// both together. With fewer than some ten values the interval covers the true value too seldom; for the extremes of a sample
/// it is meaningless. The same seed gives the same interval. The interval is NaN when a repetition gives NaN. Throws
/// InvalidInput for a sample without values and unless there are at least 2 repetitions. Source: B. Efron & R. J. Tibshirani,
/// "An Introduction to the Bootstrap", 1993, section 13.3 (percentile interval).
[[nodiscard]] Interval bootstrap_interval(std::span<const double> sample,
                                          const std::function<double(std::span<const double>)>& statistic,
                                          const BootstrapOptions& options = {});

namespace internal {

/// Checks the number of repetitions and the confidence. Throws InvalidInput as bootstrap_interval() does.
void check(const BootstrapOptions& options);

/// Returns the index of the data row, below `count`, that bootstrap repetition number `repetition` draws as its row number
/// `place`.
[[nodiscard]] std::size_t bootstrap_row(std::uint64_t seed, std::size_t repetition, std::size_t place, std::size_t count);

/// Returns the percentile interval of a statistic: the middle share `confidence` of its `values` over the bootstrap
/// repetitions; NaN when a value is NaN.
[[nodiscard]] Interval percentile_interval(std::span<const double> values, double confidence);

}  // namespace internal

}  // namespace softland
