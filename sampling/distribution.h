// Distributions of one variable, such as a dimension, a pressure or a surface energy of the switches of a wafer.
//
//   normal      f(x) ~ exp(-(x - m)^2 / (2 s^2))                      mean m, standard deviation s > 0
//   lognormal   ln x is normal; given by the mean m > 0 and standard deviation s > 0 of x itself:
//               the variance of ln x is ln(1 + (s/m)^2), its mean ln m - ln(1 + (s/m)^2) / 2
//   uniform     f(x) constant                                         low < high
//   triangular  f(x) rises from low to mode and falls to high         low <= mode <= high, low < high
//   empirical   Q(p) = x_j + (h - j) (x_(j+1) - x_j),  h = 1 + (n - 1) p,  j = floor(h),  x_1 <= ... <= x_n
//
// The quantile of n values is linear between order statistics: definition 7 of Hyndman & Fan, The American Statistician 50
// (1996) 361. So an empirical distribution has no value outside the given values, a step where values are equal, and a variance
// slightly below that of the values.
//
// Each distribution of a variable X may be truncated to [low, high]: that of X on condition that low <= X <= high. With Q the
// quantile and F the distribution function of X, the quantile of the truncated distribution is Q(F(low-) + p (F(high) -
// F(low-))), where F(low-) = P(X < low). All numbers are in the unit of the variable.
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <variant>
#include <vector>

#include "base/choice.h"
#include "sampling/interval.h"

namespace softland {

enum class DistributionKind { normal, lognormal, uniform, triangular, empirical };

/// A kind of distribution, its name, and the keys that name its parameters in a scene and in InvalidParameter.
struct DistributionRow {
  DistributionKind value;
  std::string_view name;
  Words keys;
};
inline constexpr std::array distribution_kinds{
    DistributionRow{DistributionKind::normal, "normal", {"mean", "standard_deviation"}},
    DistributionRow{DistributionKind::lognormal, "lognormal", {"mean", "standard_deviation"}},
    DistributionRow{DistributionKind::uniform, "uniform", {"low", "high"}},
    DistributionRow{DistributionKind::triangular, "triangular", {"low", "mode", "high"}},
    DistributionRow{DistributionKind::empirical, "empirical", {"values"}},
};
static_assert(is_complete<distribution_kinds>());

struct Normal {
  double mean = 0;
  double standard_deviation = 0;
};
struct Lognormal {
  double mean = 0;                ///< mean of the variable, not of its logarithm
  double standard_deviation = 0;  ///< standard deviation of the variable, not of its logarithm
};
struct Uniform {
  double low = 0;
  double high = 0;
};
struct Triangular {
  double low = 0;
  double mode = 0;
  double high = 0;
};
struct Empirical {
  std::vector<double> values = {};  ///< values of the sample, at least two, in any order
};
struct Truncation {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

class Distribution {
 public:
  /// Parameters of a distribution. The alternatives are in the order of DistributionKind.
  using Parameters = std::variant<Normal, Lognormal, Uniform, Triangular, Empirical>;

  /// Least probability of the values that a truncation keeps. A smaller one is likely a mistake of units, and the quantiles
  /// would have rounding errors.
  static constexpr double least_kept = 1e-6;

  /// Throws InvalidParameter for invalid parameters; its parameter() is a key of distribution_kinds, truncate_low or
  /// truncate_high.
  explicit Distribution(Parameters parameters, const Truncation& truncation = {});

  [[nodiscard]] DistributionKind kind() const { return static_cast<DistributionKind>(parameters_.index()); }
  /// Returns the parameters as given, with the values of an empirical distribution sorted.
  [[nodiscard]] const Parameters& parameters() const { return parameters_; }
  [[nodiscard]] const Truncation& truncation() const { return truncation_; }

  /// Returns the least x with cdf(x) >= p, for a probability p. Throws InvalidInput unless 0 < p < 1.
  [[nodiscard]] double quantile(double p) const;
  /// Returns the probability of a value of at most x.
  [[nodiscard]] double cdf(double x) const;
  /// Return the mean and the standard deviation of the distribution after truncation. Their error is below 1e-12 of the larger
  /// of the two.
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double standard_deviation() const { return standard_deviation_; }
  [[nodiscard]] const Interval& support() const { return support_; }

 private:
  void find_moments();

  Parameters parameters_;
  Truncation truncation_;
  Interval support_;
  double below_ = 0;  // probability of the values below the truncated range
  double kept_ = 1;   // probability of the values in the truncated range
  double mean_ = 0, standard_deviation_ = 0;
};

}  // namespace softland
