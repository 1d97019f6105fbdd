#pragma once

namespace softland {

/// The distribution function of the standard normal distribution, and its inverse, the quantile, for 0 < p < 1. Both throw
/// std::domain_error for NaN. The quantile throws std::domain_error also for p outside of [0, 1], and std::overflow_error for p
/// so near to 0 or 1 that it is infinite.
[[nodiscard]] double standard_normal_cdf(double z);
[[nodiscard]] double standard_normal_quantile(double p);

}  // namespace softland
