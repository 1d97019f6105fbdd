// Bang-bang landings of an undamped switch of one degree of freedom; the search for the real switch begins with them.
//
//   m x'' = -U'(x),  U = U_driven on the way to x_s, U_coasting from there on
//
// from rest at x_0 to rest at the contact x_c. The work-energy balance gives x_s: what the drive has done on the way to x_s takes
// the switch, coasting, to x_c and no further,
//
//   U_driven(x_0) - U_driven(x_s) = U_coasting(x_c) - U_coasting(x_s)
//
// The two times are quadratures of dx / v, v^2 = 2 (energy - U) / m. With the largest pull first and the least one after it,
// this is the quickest of all landings at zero speed. The force enters linearly, so that the best drive jumps between its
// bounds (Pontryagin), and one jump is enough to reach a point of rest. For a plate on a spring the balance is the formula of
// Czaplewski, Dyck, Sumali et al., J. Micromech. Microeng. 16 (2006) 1.
// Valid without damping and contact forces, where U_coasting rises up to x_c. No solution exists where the drive does not reach
// x_c, or coasting alone does.
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

/// Returns x_s [m], or nothing if no solution exists.
[[nodiscard]] std::optional<double> switching_position(const Potential& driven, const Potential& coasting, double from,
                                                       double contact);

struct BangBang {
  double switching_position = 0;  ///< position x_s where the drive ends [m]
  double driven_time = 0;         ///< time from rest to x_s [s]
  double coasting_time = 0;       ///< time from x_s to rest at the contact [s]
};

/// `mass` [kg]; `from` and `contact` are x_0 and x_c [m].
[[nodiscard]] std::optional<BangBang> bang_bang(const Potential& driven, const Potential& coasting, double mass, double from,
                                                double contact);

/// Computes the landing of a switch that moves in its first mode alone, from rest under the drive values `before` (none: 0).
/// The drives have the values `driven` up to x_s, and `coasting` after it.
[[nodiscard]] std::optional<BangBang> bang_bang(const Switch& model, const std::vector<double>& driven,
                                                const std::vector<double>& coasting, std::span<const double> before = {});

}  // namespace softland
