#pragma once

namespace softland {

/// The standard normal distribution, mean 0 and standard deviation 1: the probability of at most z, and its inverse on 0 < p <
/// 1. Arguments outside these ranges throw std::domain_error, those near 0 or 1 whose quantile is infinite std::overflow_error.
[[nodiscard]] double standard_normal_cdf(double z);
[[nodiscard]] double standard_normal_quantile(double p);

}  // namespace softland
