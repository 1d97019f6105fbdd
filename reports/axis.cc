#include "reports/axis.h"

#include <algorithm>
#include <cmath>

namespace softland::internal {

double Axis::transformed(double value) const { return scale == Scale::linear ? value : std::log10(value); }

double Axis::pixel(double value) const {
  constexpr double farthest = 1e7;  // any paper ends before
  const double from = transformed(low);
  const double at = pixel_low + (transformed(value) - from) / (transformed(high) - from) * (pixel_high - pixel_low);
  return std::clamp(at, -farthest, farthest);
}

std::vector<double> ticks(const Axis& axis, int wanted) {
  std::vector<double> out;
  if (axis.scale == Scale::linear) {
    const double raw = (axis.high - axis.low) / wanted;
    const double decade = std::pow(10, std::floor(std::log10(raw)));
    double step = 10 * decade;
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor * decade >= raw * (1 - 1e-9)) {
        step = factor * decade;
        break;
      }
    }
    for (double k = std::ceil(axis.low / step - 1e-9); k * step <= axis.high + 1e-9 * step; ++k) out.push_back(k * step);
    return out;
  }
  const int first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(axis.high) + 1e-9));
  const int every = std::max(1, (last - first + 7) / 8);
  for (int exponent = first; exponent <= last; exponent += every) out.push_back(std::pow(10, exponent));
  if (out.size() > 2) return out;
  out.clear();  // few decades: their parts as well
  for (int exponent = first - 1; exponent <= last; ++exponent) {
    for (const double part : {1.0, 2.0, 5.0}) {
      const double tick = part * std::pow(10, exponent);
      if (tick >= axis.low * (1 - 1e-9) && tick <= axis.high * (1 + 1e-9)) out.push_back(tick);
    }
  }
  return out;
}

}  // namespace softland::internal
