#include "base/gauss.h"

#include <cmath>

#include "base/decompositions.h"

namespace softland {

GaussRule gauss_rule(int n) {
  Eigen::VectorXd off(n > 1 ? n - 1 : 0);
  for (int k = 1; k < n; ++k) off[k - 1] = k / std::sqrt(4.0 * k * k - 1);
  const SymmetricEigen jacobi = tridiagonal_eigen(Eigen::VectorXd::Zero(n), off);
  GaussRule rule;
  for (int i = 0; i < n; ++i) {
    rule.points.push_back(jacobi.values[i]);
    rule.weights.push_back(2 * jacobi.vectors(0, i) * jacobi.vectors(0, i));
  }
  return rule;
}

}  // namespace softland
