// The common part of all gas film laws: state of the gas, parameters and limits of a law, and keys of a scene for the state.
#pragma once

#include <array>
#include <limits>
#include <string_view>

#include "base/field.h"

namespace softland {

/// The state of the gas around the beam. The header model/gas/air.h has the defaults of numbers that are not given.
struct FilmState {
  double viscosity = not_given;       ///< viscosity of the gas [Pa s]; by default that of air
  double pressure = 101325;           ///< ambient pressure [Pa]
  double temperature = 300;           ///< temperature of the gas [K]
  double mean_free_path = not_given;  ///< mean free path of the gas [m]; by default from viscosity, pressure, temperature
};

/// The numbers from which the gas laws compute their parameters for a device.
struct Film {
  double width, thickness;  ///< width and thickness of the moving part [m]
  double viscosity;         ///< viscosity of the gas, reduced as film damping is by open ends (end_flow()) [Pa s]
  double mean_free_path;    ///< mean free path of the gas [m]
  double unit_quality;      ///< damping per length at which the first mode has a quality factor of one [N s/m^2]
};

/// Largest squeeze number at which the gas film under a strip counts as incompressible; at pi^2 the damping and spring forces
/// of the film are about equal.
inline constexpr double incompressible = 10;

/// The range in which a gas law is valid; a closing beyond this range causes a warning.
struct FilmLimits {
  double least_knudsen = 0;
  double most_knudsen = std::numeric_limits<double>::infinity();
  /// Largest squeeze number 12 mu a^2 omega / (p h^2) of the film: viscosity mu, width a, ambient pressure p, gap h, and
  /// relative rate of change of the gap omega [1/s].
  double most_squeeze = std::numeric_limits<double>::infinity();
  bool needs_thickness = false;  ///< true when the law needs the thickness of the moving part
};

// clang-format off
// Returns the scene-file keys of the state of the gas, which is the member `film` of a gas law.
template <class Law>
[[nodiscard]] consteval auto film_fields() {
  return std::to_array<Field<Law>>({
      {.key = "viscosity", .unit = "Pa s", .about = "dynamic viscosity; absent: that of air at the temperature", .in = reach<Law, &Law::film, &FilmState::viscosity>},
      {.key = "pressure", .unit = "Pa", .about = "ambient; strip and strip-slit: changes only their warnings, not their damping", .in = reach<Law, &Law::film, &FilmState::pressure>, .fallback = "'101325 Pa'"},
      {.key = "temperature", .unit = "K", .about = "of the gas", .in = reach<Law, &Law::film, &FilmState::temperature>, .fallback = "'300 K'"},
      {.key = "mean_free_path", .unit = "m", .about = "at the ambient pressure; absent: from viscosity, pressure and temperature", .in = reach<Law, &Law::film, &FilmState::mean_free_path>, .range = {.least = 0, .most = 1e9, .least_open = true}, .such_as = "65 nm"},
  });
}
/// Returns the scene-file key of the length of a single gas film with open ends.
template <class Law>
[[nodiscard]] consteval auto end_fields() {
  return std::to_array<Field<Law>>({{.key = "film_length", .unit = "m", .about = "length of one film, whose gas leaves at its ends too; absent: much longer than wide", .in = reach<Law, &Law::film_length>, .such_as = "100 um"}});
}
/// Returns the scene-file key of the thickness at rest of a second gas film, on the far side.
template <class Law>
[[nodiscard]] consteval auto far_fields() {
  return std::to_array<Field<Law>>({{.key = "far_gap", .unit = "m", .about = "rest thickness of a second film on the far side; absent: none", .in = reach<Law, &Law::far_gap>}});
}
// clang-format on

}  // namespace softland
