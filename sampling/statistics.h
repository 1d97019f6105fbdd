// Statistics of a sample: values of one figure of merit on simulated devices. Larger values are worse. The value of a device
// that failed is +infinity.
//
// Mean, standard deviation and conditional value at risk are infinite as soon as they use an infinite value; the skewness is
// then NaN. A quantile is infinite when it uses an infinite order statistic. So the quantile p is finite as long as less than
// about a share 1 - p of the devices fails, but the mean only if none fails.
//
// Every function throws InvalidInput for a sample without values, and for one with NaN or -infinity. All results are in the
// unit of the sample.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace softland {

[[nodiscard]] double sample_mean(std::span<const double> sample);

/// Returns the standard deviation of a sample, the square root of sum (x - mean)^2 / (n - 1); NaN for one value.
[[nodiscard]] double sample_standard_deviation(std::span<const double> sample);

/// Returns the skewness of a sample, G_1 = sqrt(n (n - 1)) / (n - 2) m_3 / m_2^(3/2), with m_k = sum (x - mean)^k / n. It is
/// the adjusted Fisher-Pearson estimator, which has no bias for a normal distribution (D. N. Joanes & C. A. Gill, The
/// Statistician 47 (1998) 183). The result is NaN for fewer than three values, for equal values, and for a sample with an
/// infinite value.
[[nodiscard]] double sample_skewness(std::span<const double> sample);

/// Returns a quantile of a sample that is linear between order statistics: x_j + (h - j) (x_(j+1) - x_j), h = 1 + (n - 1) p, j
/// = floor(h), which is definition 7 of Hyndman & Fan, The American Statistician 50 (1996) 361. Throws InvalidInput unless 0 <=
/// p <= 1.
[[nodiscard]] double sample_quantile(std::span<const double> sample, double p);

/// Returns the conditional value at risk: the mean of the worst 1 - alpha of the sample,
///
///   CVaR = (sum_(i <= w) x_i + (m - w) x_(w+1)) / m,   m = (1 - alpha) n,   w = floor(m),   x_1 >= ... >= x_n
///
/// This is the least value of c + mean(max(x - c, 0)) / (1 - alpha) over c. With m < 1 it is the worst value. Throws
/// InvalidInput unless 0 <= alpha < 1. Source: R. T. Rockafellar & S. Uryasev, Journal of Risk 2 (2000) 21.
[[nodiscard]] double conditional_value_at_risk(std::span<const double> sample, double alpha);

/// Histogram with bins of equal width over the finite values; the last bin includes both its ends.
struct Histogram {
  double low = 0, high = 0;              ///< low end of the first bin and high end of the last; equal when all values are equal
  std::vector<std::size_t> counts = {};  ///< counts of the histogram's bins; empty where no value is finite
  std::size_t infinite = 0;              ///< number of infinite values, which are in no bin
};

/// Returns the histogram of the finite values. The width of the bins is that of Freedman & Diaconis, 2 IQR n^(-1/3) (Z.
/// Wahrscheinlichkeitstheorie 57 (1981) 453); when the interquartile range IQR is 0 there are 1 + log2(n) bins (Sturges 1926).
/// There are at most `most_bins` bins. Throws InvalidInput when `most_bins` is 0.
[[nodiscard]] Histogram histogram(std::span<const double> sample, std::size_t most_bins = 100);

namespace internal {
/// Checks the values of a sample. Throws InvalidInput for a sample without values, and for one with NaN or -infinity.
void check_sample(std::span<const double> sample);
/// Returns sample_quantile() of values in ascending order, without checks; the lowest values may be -infinity.
[[nodiscard]] double quantile_of_sorted(std::span<const double> sorted, double p);
}  // namespace internal

}  // namespace softland
