// Tolerances for figures of the two gold cantilevers, compared with independent programs.
#pragma once

namespace softland::test {

inline constexpr double frequency_digits = 1e-5;  // relative; the references have seven to eight digits
inline constexpr double time_digits = 5e-4;       // relative, as promised to users; the references have errors of 1e-5
inline constexpr double impact_digits = 5e-3;     // relative, for v_i and B_H: touches magnify the errors of the flight
inline constexpr double fine = 1e-8;              // integrator tolerance with which every figure here has converged

}  // namespace softland::test
