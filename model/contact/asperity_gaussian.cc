#include "model/contact/asperity_gaussian.h"

#include <algorithm>
#include <vector>

#include "model/constants.h"
#include "model/dual.h"

namespace softland {
namespace internal {

GaussianTail::GaussianTail() {
  constexpr double order = 1.5, start = 14;
  constexpr std::size_t terms = 24;
  std::array<double, terms> c{};
  // Computes the coefficients c of the Taylor series about h of a solution of y'' + h y' - n y = 0, where n is `order`, from
  // its value c[0] and slope c[1].
  const auto expand = [&](double h) {
    for (std::size_t k = 0; k + 2 < terms; ++k) {
      const auto j = static_cast<double>(k);
      c[k + 2] = ((order - j) * c[k] - h * (j + 1) * c[k + 1]) / ((j + 2) * (j + 1));
    }
  };
  c[0] = 1;
  // Start with the value 1 and with the ratio of slope to value that F_n has for large h. The error of this start decays
  // towards smaller h.
  c[1] = -(start + (order + 1) / start);
  constexpr auto above = static_cast<std::size_t>((start - last) / spacing);
  for (std::size_t i = nodes + above; i-- > 0;) {
    expand(first + spacing * static_cast<double>(i));
    if (i < nodes) std::copy_n(c.begin(), series_[i].size(), series_[i].begin());
    double value = 0, slope = 0;
    for (std::size_t k = terms; k-- > 0;) {
      slope = slope * -spacing + value;
      value = value * -spacing + c[k];
    }
    c[0] = value;
    c[1] = slope;
    if (i == 0) break;
  }
  constexpr auto zero = static_cast<std::size_t>(-first / spacing);
  const double scale = std::pow(2, order / 2 - 1) * std::tgamma((order + 1) / 2) / std::sqrt(pi) / series_[zero][0];
  for (Series& one : series_) {
    for (double& coefficient : one) coefficient *= scale;
  }
}

const GaussianTail& GaussianTail::instance() {
  static const GaussianTail table;
  return table;
}

}  // namespace internal

template <>
double GaussianAsperityContact::next_tail(double h) {
  const Dual at = tail(Dual(h, 1));
  return -at.slope - h * at.value;
}

}  // namespace softland
