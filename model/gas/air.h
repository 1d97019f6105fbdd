// State of the gas: viscosity and mean free path, by one convention for all gas laws.
//
//   mu(T) = beta T^(3/2) / (T + S)                          air, where a scene gives no viscosity
//   lambda = (mu / p) sqrt(pi R_g T / 2)                    where a scene gives no mean free path
//   Kn = lambda / h
//
// beta = 1.458e-6 kg/(s m K^(1/2)), S = 110.4 K, mu is the viscosity [Pa s], T temperature [K], p ambient pressure [Pa], R_g =
// 287 J/(kg K) of air, lambda mean free path [m], h local gap [m], Kn Knudsen number. lambda follows from the viscosity in use,
// given in the scene or not: 67.00 nm for air at 101325 Pa and 300 K. Other conventions (hard spheres: about 53 nm) differ by
// 20 %; with another convention, give mean_free_path in the scene. Sources: W. Sutherland, Phil. Mag. 36 (1893) 507, with the
// constants of U.S. Standard Atmosphere, 1976, eq. 51, for 100 to 1900 K; textbook definition of the viscosity-based mean free
// path.
#pragma once

#include <cmath>

#include "model/constants.h"
#include "model/gas/film.h"

namespace softland {

inline constexpr double gas_constant_of_air = 287;  ///< specific gas constant of air [J/(kg K)]

[[nodiscard]] inline double air_viscosity(double temperature) {
  constexpr double beta = 1.458e-6, sutherland = 110.4;
  return beta * temperature * std::sqrt(temperature) / (temperature + sutherland);
}

/// Returns the viscosity of the gas [Pa s]: the given value, or that of air.
[[nodiscard]] inline double viscosity(const FilmState& gas) {
  return std::isnan(gas.viscosity) ? air_viscosity(gas.temperature) : gas.viscosity;
}
/// Returns the mean free path of the gas [m]: the given value, or that from viscosity, pressure and temperature.
[[nodiscard]] inline double mean_free_path(const FilmState& gas) {
  if (!std::isnan(gas.mean_free_path)) return gas.mean_free_path;
  return viscosity(gas) / gas.pressure * std::sqrt(pi * gas_constant_of_air * gas.temperature / 2);
}

}  // namespace softland
