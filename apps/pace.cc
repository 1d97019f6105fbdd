#include "apps/pace.h"

#include <algorithm>
#include <limits>

namespace softland::apps {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double Pace::to_compute() const {
  const auto taken = static_cast<double>(computed + reused), left = static_cast<double>(remaining);
  if (taken == 0) return unknown;
  const double share = static_cast<double>(reused) / taken;
  const auto rows_left = static_cast<double>(std::max<std::int64_t>(0, earlier - reused));
  return left - std::min(share * left, rows_left);
}

double Pace::seconds_left() const { return computed > 0 ? to_compute() * seconds / static_cast<double>(computed) : unknown; }

}  // namespace softland::apps
