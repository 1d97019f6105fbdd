// Landings of an undamped switch of one degree of freedom: where a search for the real one begins.
//
//   m x'' = -U'(x),  U = U_driven on the way to x_s, U_coasting from there on
//
// from rest at x_0 to rest at the contact x_c. The work-energy balance gives x_s: what the drive has done on the way to x_s takes
// the switch, coasting, to x_c and no further,
//
//   U_driven(x_0) - U_driven(x_s) = U_coasting(x_c) - U_coasting(x_s)
//
// and the two times are quadratures of dx / v, v^2 = 2 (energy - U) / m. With the largest pull first and the least one after it
// this is the quickest of all landings at zero speed: the force enters linearly, so that the best drive jumps between its bounds
// (Pontryagin), and one jump is enough to reach a point of rest. Of a plate on a spring the balance is the formula of Czaplewski,
// Dyck, Sumali et al., J. Micromech. Microeng. 16 (2006) 1.
// Valid without damping and contact forces, where U_coasting rises up to x_c; there is none where the drive does not reach x_c,
// or coasting alone does.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "studies/closing/prepared.h"

namespace softland {

/// Potential energy over the position [m] -> [J].
using Potential = std::function<double(double)>;

/// x_s [m]; nothing where there is none.
[[nodiscard]] std::optional<double> switching_position(const Potential& driven, const Potential& coasting, double from,
                                                       double contact);

struct BangBang {
  double switching_position = 0;  ///< [m]
  double driven_time = 0;         ///< from rest to there [s]
  double coasting_time = 0;       ///< from there to rest at the contact [s]
};

/// `mass` [kg]; `from` and `contact` are x_0 and x_c [m].
[[nodiscard]] std::optional<BangBang> bang_bang(const Potential& driven, const Potential& coasting, double mass, double from,
                                                double contact);

/// That of a switch which moves in its first mode alone, under these values of its drives while it is driven and while it coasts,
/// from rest under those `before` (none: 0).
[[nodiscard]] std::optional<BangBang> bang_bang(const Switch& model, const std::vector<double>& driven,
                                                const std::vector<double>& coasting, std::span<const double> before = {});

}  // namespace softland
