// Physical constants (CODATA 2018).
#pragma once

namespace softland {

inline constexpr double vacuum_permittivity = 8.8541878128e-12;     ///< vacuum permittivity [F/m]
inline constexpr double reduced_planck_constant = 1.054571817e-34;  ///< reduced Planck constant [J s]
inline constexpr double speed_of_light = 299792458;                 ///< speed of light in vacuum [m/s]
inline constexpr double pi = 3.14159265358979323846;

}  // namespace softland
