// The explicit Runge-Kutta pair 5(4) of Dormand & Prince 1980 (RK5(4)7M), and the constants of its step size control:
// proportional-integral (Gustafsson 1991) with the exponents of Hairer & Wanner 1996, IV.2.
#pragma once

namespace softland {

struct DormandPrince {
  static constexpr double nodes[7] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
  static constexpr double tableau[7][6] = {{},
                                           {1.0 / 5},
                                           {3.0 / 40, 9.0 / 40},
                                           {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                           {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                           {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                           {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
  /// Weights of the slopes of the stages in the error estimate, which is the solution of fifth order minus that of fourth
  /// order.
  static constexpr double difference[7] = {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

  static constexpr float integral = 0.04F, proportional = 0.2F - 0.75F * integral;
  static constexpr double safety = 0.9;
  static constexpr double least_growth = 0.2, most_growth = 10;
  /// Largest growth factor of the step length after the first step, whose length is only a guess.
  static constexpr double first_growth = 1e4;
  static constexpr float least_error = -13;  ///< lower bound of the last error in the step size control, binary logarithm
  static constexpr double not_finite = 0.1;  ///< factor on the step length after an error estimate that is not finite
};

}  // namespace softland
