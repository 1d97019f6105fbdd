#include "reports/estimates.h"

#include <fmt/format.h>

#include <cmath>

#include "document/quantity.h"

namespace softland::internal {

std::string yield_text(const Yield& yield) {
  return fmt::format("{} ({} to {})", percent(yield.value), plain_number(100 * yield.interval.low),
                     plain_number(100 * yield.interval.high));
}

std::string quantile_text(const EstimatedQuantile& q, std::string_view unit) {
  if (std::isinf(q.value)) return "∞";
  const double factor = unit.empty() ? 1 : prefix_for(q.value).factor;
  const auto bound = [&](double value) { return std::isfinite(value) ? plain_number(value / factor) : std::string("—"); };
  if (!std::isfinite(q.interval.low) && !std::isfinite(q.interval.high)) return fmt::format("{} (—)", quantity(q.value, unit));
  return fmt::format("{} ({} to {})", quantity(q.value, unit), bound(q.interval.low), bound(q.interval.high));
}

}  // namespace softland::internal
