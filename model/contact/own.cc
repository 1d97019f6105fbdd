#include "model/contact/own.h"

#include <cstddef>

#include "base/gauss.h"

namespace softland {

double OwnContactLaw::energy(double interference) const {
  static const GaussRule rule = gauss_rule(24);
  double sum = 0;
  for (std::size_t i = 0; i < rule.points.size(); ++i) {
    const double root = (1 + rule.points[i]) / 2;
    sum += rule.weights[i] * root * force(interference * root * root, 0);
  }
  return interference * sum;
}

}  // namespace softland
