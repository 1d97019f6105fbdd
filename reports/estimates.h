// Formats shares and quantiles of devices with their confidence intervals.
#pragma once

#include <string>
#include <string_view>

#include "studies/devices/robustness.h"

namespace softland::internal {

/// Returns a share of devices with its confidence interval as text: "3.4 % (2.7 to 4.3)".
[[nodiscard]] std::string yield_text(const Yield& yield);
/// Returns a quantile with its confidence interval as text: "26.9 mm/s (26.6 to 27.1)"; an infinite value is "∞".
[[nodiscard]] std::string quantile_text(const EstimatedQuantile& quantile, std::string_view unit);

}  // namespace softland::internal
