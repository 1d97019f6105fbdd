#include "document/axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace softland::internal {

double drawable(double value) {
  constexpr double most = 1e100;
  if (!(std::abs(value) <= most)) return std::numeric_limits<double>::quiet_NaN();
  return std::abs(value) < 1 / most ? 0 : value;
}

Points drawable(const Points& points) {
  Points all;
  for (const auto& [x, y] : points) {
    const std::array point{drawable(x), drawable(y)};
    if (std::isfinite(point[0]) && std::isfinite(point[1])) all.push_back(point);
  }
  return all;
}

double Axis::transformed(double value) const { return scale == AxisScale::linear ? value : std::log10(value); }

double Axis::pixel(double value) const {
  constexpr double farthest = 1e7;  // largest absolute coordinate, far outside the picture [px]
  const double part = part_between(transformed(low), transformed(high), transformed(value));
  return std::clamp(pixel_low + part * (pixel_high - pixel_low), -farthest, farthest);
}

double part_between(double low, double high, double value) {
  constexpr double middle = 0.5, quarter = 0.25;  // differences of a quarter of each number do not overflow
  const double way = high - low;
  const double part =
      std::isfinite(way) ? (value - low) / way : (quarter * value - quarter * low) / (quarter * high - quarter * low);
  return std::isnan(part) ? middle : part;
}

namespace {

/// Returns about `wanted` ticks at the multiples of a step, which is 1, 2 or 5 times a power of ten.
std::vector<double> linear_ticks(double low, double high, int wanted) {
  const double raw = std::isfinite(high - low) ? (high - low) / wanted : high / wanted - low / wanted;
  const double decade = std::pow(10, std::floor(std::log10(raw)));
  double step = 10 * decade;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= raw * (1 - 1e-9)) {
      step = factor * decade;
      break;
    }
  }
  const double first = std::ceil(low / step - 1e-9);
  constexpr double countable = 4503599627370496;  // 2^52: larger doubles are whole numbers
  if (!(step > 0 && std::abs(first) < countable)) return low < high ? std::vector{low, high} : std::vector{low};
  std::vector<double> out;
  for (int k = 0; k <= 10 * wanted; ++k) {
    const double tick = (first + k) * step;
    if (!(tick <= high + 1e-9 * step && std::isfinite(tick))) break;
    out.push_back(tick);
  }
  return out;
}

}  // namespace

std::vector<double> ticks(const Axis& axis, int wanted) {
  if (!std::isfinite(axis.low) || !std::isfinite(axis.high) || axis.low > axis.high) return {};
  if (axis.scale == AxisScale::linear) return linear_ticks(axis.low, axis.high, wanted);
  if (!(axis.low > 0)) return {};
  std::vector<double> out;
  const int first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(axis.high) + 1e-9));
  const int every = std::max(1, (last - first + 7) / 8);
  for (int exponent = first; exponent <= last; exponent += every) out.push_back(std::pow(10, exponent));
  if (out.size() > 2) return out;
  out.clear();  // with fewer than three powers of ten on the axis, put ticks at 2 and 5 times each power as well
  for (int exponent = first - 1; exponent <= last; ++exponent) {
    for (const double part : {1.0, 2.0, 5.0}) {
      const double tick = part * std::pow(10, exponent);
      if (std::isfinite(tick) && tick >= axis.low * (1 - 1e-9) && tick <= axis.high * (1 + 1e-9)) out.push_back(tick);
    }
  }
  return out;
}

}  // namespace softland::internal
