// Dispersion force between beam and electrode plane, per length, over the whole length; and the rule that chooses between its
// two limits.
//
//   f(h) = F a p(h)     [N/m], positive towards the electrode      stored energy F a u(h) [J/m], p = u'(h)
//
// h is the local gap [m], a the width [m], F the force factor (1 = nominal; a drive can change it, e.g. a phase change of the
// plate), p one of the laws per area: van_der_waals.h, casimir.h, gold_casimir.h, or the smaller of both limits:
//
//   p(h) = min(A / (6 pi h^3), p_Casimir(h)) - repulsion of van_der_waals.h
//
// Van der Waals and Casimir force are limits of one force, so they are never added: below the crossover the van der Waals law
// is the smaller one, above it the Casimir law. There is one crossover (pi^3 hbar c / (40 A) for ideal conductors, 61 nm at A =
// 4e-19 J) or, where the Casimir law of a real metal is smaller everywhere, none. At the crossover the force is continuous and
// its slope jumps by a quarter. A run needs no restart there: every quadrature point crosses at its own time and carries a
// small part of the load, and step size control absorbs the kink (the energy tests close the balance across it).
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
  /// Gap at which the force changes from the van der Waals to the Casimir law [m]; 0 if it does not.
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
  // The crossover between the laws needs no derivatives: the force is continuous there, and a shift of the crossover changes no
  // force.
  [[nodiscard]] P find_crossover() const {
    if constexpr (requires { van_der_waals.hamaker_constant.value; }) {
      return P(crossover_of(van_der_waals.hamaker_constant.value));
    } else {
      return one_by_one(van_der_waals.hamaker_constant, [this](double hamaker) { return crossover_of(hamaker); });
    }
  }
  // The ratio of Casimir to van der Waals law falls monotonically with the gap: bisect its logarithm.
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

  /// Returns the dispersion load on the beam [N/m] at force factor 1.
  template <class S>
  S load(S gap, S /*velocity*/) const {
    return S(width) * law.pressure(gap);
  }
  /// Returns the potential of the dispersion force [J/m] at force factor 1.
  [[nodiscard]] double potential(double gap) const { return width * law.energy(gap); }
};

}  // namespace softland
