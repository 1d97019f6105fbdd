// Bang-bang closings, with zero speed at the contact, of an undamped switch of one degree of freedom: starting points of the
// search for the real switch.
//
//   m x'' = -U'(x),  U = U_driven from x_0 to x_s, U_coasting from x_s to x_c
//
// from rest at x_0 to rest at the contact x_c. The work-energy balance gives x_s: with the kinetic energy gained up to x_s, the
// coasting switch just reaches x_c,
//
//   U_driven(x_0) - U_driven(x_s) = U_coasting(x_c) - U_coasting(x_s)
//
// The two times are quadratures of dx / v, v^2 = 2 (energy - U) / m. With the largest pull first and the least pull afterwards,
// no closing at zero speed is quicker: the force enters linearly, so that the optimal drive jumps between its bounds
// (Pontryagin), and one jump is enough to reach a point of rest. For a plate on a spring the balance is the formula of
// Czaplewski, Dyck, Sumali et al., J. Micromech. Microeng. 16 (2006) 1. Valid without damping and contact forces, where
// U_coasting rises up to x_c. No solution exists if the driven switch does not reach x_c, or if the switch reaches x_c by
// coasting alone.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "studies/closing/prepared.h"

namespace softland {

/// Potential energy [J] as a function of the position [m].
using Potential = std::function<double(double)>;

/// Returns the position x_s [m] where the drive has to jump from its pulling to its coasting value, or nothing if no solution
/// exists.
[[nodiscard]] std::optional<double> switching_position(const Potential& driven, const Potential& coasting, double from,
                                                       double contact);

struct BangBang {
  double switching_position = 0;  ///< position x_s where the drive jumps from pulling to coasting [m]
  double driven_time = 0;         ///< time of the motion from rest at x_0 to x_s [s]
  double coasting_time = 0;       ///< time of the motion from x_s to rest at the contact [s]
};

/// Returns the closing with zero speed at the contact of a mass [kg] from x_0 = `from` to x_c = `contact` [m], or nothing if no
/// solution exists.
[[nodiscard]] std::optional<BangBang> bang_bang(const Potential& driven, const Potential& coasting, double mass, double from,
                                                double contact);

/// Computes the closing with zero speed at the contact of a switch that moves in its first mode alone, from rest under the
/// drive values `before` (empty: 0). The drives pull with the values `driven` up to the switching position x_s, and have the
/// values `coasting` after it. Returns nothing if no such closing exists.
[[nodiscard]] std::optional<BangBang> bang_bang(const Switch& model, const std::vector<double>& driven,
                                                const std::vector<double>& coasting, std::span<const double> before = {});

}  // namespace softland
