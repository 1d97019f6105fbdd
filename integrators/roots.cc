#include "integrators/roots.h"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

namespace softland::internal {

double bracketed_zero(Function f, double low, double high) {
  const double f_low = f(low), f_high = f(high);
  double zero = low, least = std::abs(f_low);
  const auto keep = [&](double t, double value) {
    if (std::abs(value) < least) zero = t, least = std::abs(value);
    return value;
  };
  keep(high, f_high);
  if (!(f_low < 0 && f_high > 0) && !(f_low > 0 && f_high < 0)) return zero;
  const auto neighbours = [](double a, double b) {
    const double middle = a + (b - a) / 2;
    return !(middle > a && middle < b);
  };
  std::uintmax_t most = 200;  // largest number of evaluations of f
  boost::math::tools::toms748_solve([&](double t) { return keep(t, f(t)); }, low, high, f_low, f_high, neighbours, most);
  return zero;
}

}  // namespace softland::internal
