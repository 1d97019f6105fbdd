#pragma once

namespace softland {

/// The distribution function of the standard normal distribution, and its inverse on 0 < p < 1. Arguments outside these ranges
/// throw std::domain_error; a p so near to 0 or 1 that the quantile is infinite throws std::overflow_error.
[[nodiscard]] double standard_normal_cdf(double z);
[[nodiscard]] double standard_normal_quantile(double p);

}  // namespace softland
