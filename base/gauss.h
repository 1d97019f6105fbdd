// Gauss-Legendre points and weights on [-1, 1] for any order; the tables in libraries end at fixed orders.
#pragma once

#include <vector>

namespace softland {

struct GaussRule {
  std::vector<double> points, weights;
};

/// Returns the rule with n points, which is exact for polynomials of degree 2 n - 1 (Golub & Welsch 1969: eigenvalues of the
/// Jacobi matrix).
[[nodiscard]] GaussRule gauss_rule(int n);

}  // namespace softland
