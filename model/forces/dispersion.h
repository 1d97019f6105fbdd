// Dispersion force (van der Waals, Casimir) between beam and electrode plane, per length of the beam and along its whole
// length; and the rule that chooses between the two limits of this force.
//
//   f(h) = F a p(h)     [N/m], positive towards the electrode      stored energy F a u(h) [J/m], p = u'(h)
//
// h is the local gap [m], a the width [m], F the force factor (1 without a drive; a drive can change F, e.g. by a phase change
// of the plate's material), p one of the laws per area: van_der_waals.h, casimir.h, gold_casimir.h, or the smaller of the van
// der Waals and the Casimir law:
//
//   p(h) = min(A / (6 pi h^3), p_Casimir(h)) - repulsion of van_der_waals.h
//
// Van der Waals and Casimir force are limits of one force, so they are never added: below the crossover the van der Waals law
// is the smaller one, above it the Casimir law. There is one crossover gap (pi^3 hbar c / (40 A) for ideal conductors, 61 nm at
// A = 4e-19 J), or none when the Casimir law of a real metal is smaller at all gaps. At the crossover the force is continuous
// and its slope jumps by a quarter. A run needs no restart there: every quadrature point crosses at its own time and carries a
// small part of the load, and step size control handles the kink. In tests, the residual of the energy balance of such runs is
// small.
#pragma once

#include <cmath>
#include <concepts>

#include "base/select.h"
#include "model/forces/van_der_waals.h"

namespace softland {

template <class Casimir, class P = double>
struct SmallerOfBoth {
  Casimir casimir;
  VanDerWaalsOf<P> van_der_waals;
  /// Gap at which the force changes from the van der Waals to the Casimir law [m]; 0 when the Casimir law holds at all gaps.
  P crossover = find_crossover();
  double energy_step = find_energy_step();

  template <class S>
  S pressure(S h) const {
    return select(
               h < crossover, [&]() -> S { return van_der_waals.attraction(h); }, [&]() -> S { return casimir.pressure(h); }) -
           van_der_waals.repulsion(h);
  }
  [[nodiscard]] double energy(double h) const {
    return (h < crossover ? energy_step + van_der_waals.attraction_energy(h) : casimir.energy(h)) +
           van_der_waals.repulsion_energy(h);
  }

 private:
  [[nodiscard]] double find_energy_step() const {
    if constexpr (std::same_as<P, double>) {
      if (crossover > 0) return casimir.energy(crossover) - van_der_waals.attraction_energy(crossover);
    }
    return 0;
  }
  // Derivatives of the crossover by parameters are not needed: since the force is continuous there, a shift of the crossover
  // changes no force.
  [[nodiscard]] P find_crossover() const {
    if constexpr (requires { van_der_waals.hamaker_constant.value; }) {
      return P(crossover_of(van_der_waals.hamaker_constant.value));
    } else {
      return one_by_one(van_der_waals.hamaker_constant, [this](double hamaker) { return crossover_of(hamaker); });
    }
  }
  // The ratio of the Casimir to the van der Waals law falls monotonically with the gap: find the gap of ratio 1 by bisection on
  // a logarithmic scale.
  [[nodiscard]] double crossover_of(double hamaker) const {
    const VanDerWaals unretarded{.hamaker_constant = hamaker};
    const auto retarded = [&](double h) { return casimir.pressure(h) < unretarded.attraction(h); };
    double low = 1e-12, high = 1e-3;
    if (retarded(low)) return 0;
    while (high > low * (1 + 1e-15)) {
      const double middle = std::sqrt(low) * std::sqrt(high);
      if (middle <= low || middle >= high) break;
      (retarded(middle) ? high : low) = middle;
    }
    return high;
  }
};

template <class Pressure, class P = double>
struct DispersionForce {
  Pressure law;
  P width = 0;  ///< width of the beam [m]
  static constexpr bool drive_depends = true;

  /// Returns the dispersion load on the beam [N/m] for the force factor 1 (no change by a drive).
  template <class S>
  S load(S gap, S /*velocity*/) const {
    return S(width) * law.pressure(gap);
  }
  /// Returns the potential of the dispersion force [J/m] for the force factor 1 (no change by a drive).
  [[nodiscard]] double potential(double gap) const { return width * law.energy(gap); }
};

}  // namespace softland
