// Physical constants (CODATA 2018).
#pragma once

namespace softland {

inline constexpr double vacuum_permittivity = 8.8541878128e-12;  ///< [F/m]
inline constexpr double pi = 3.14159265358979323846;

}  // namespace softland
