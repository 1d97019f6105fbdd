// Errors of the figures of the two gold cantilevers against independent programs.
#pragma once

namespace softland::test {

inline constexpr double frequency_digits = 1e-5;  // relative: the references have seven to eight digits
inline constexpr double time_digits = 5e-4;       // relative: what users may rely on; the references are good to 1e-5
inline constexpr double impact_digits = 5e-3;     // relative, for v_i and B_H: touches magnify what flight leaves behind
inline constexpr double fine = 1e-8;              // integrator tolerance that leaves every figure here converged

}  // namespace softland::test
