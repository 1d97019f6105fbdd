// Integration methods for the equations of motion, and their names.
#pragma once

#include <array>
#include <string_view>

namespace softland {

enum class Integrator {
  automatic,   ///< the caller chooses a method that suits its equations; make_stepper() refuses this value
  lawson,      ///< explicit Runge-Kutta 5(4) for the deviation of the modes from their free oscillation: lawson.h
  arkode_erk,  ///< explicit Runge-Kutta 5(4) for the untransformed equations of motion, by ARKODE
  esdirk,      ///< diagonally implicit Runge-Kutta 5(4), by ARKODE, with the exact Jacobian
  bdf,         ///< backward differentiation formulas, by CVODE, with the exact Jacobian
  adams,       ///< Adams-Moulton method, by CVODE, with functional iteration
};

struct IntegratorDescriptor {
  Integrator integrator;
  std::string_view name;
  bool implicit;  ///< true when every step solves equations with the Jacobian
};

/// Name and properties of every integrator except `automatic`, one line each.
inline constexpr std::array integrator_descriptors{
    IntegratorDescriptor{Integrator::lawson, "lawson", false}, IntegratorDescriptor{Integrator::arkode_erk, "arkode-erk", false},
    IntegratorDescriptor{Integrator::esdirk, "esdirk", true},  IntegratorDescriptor{Integrator::bdf, "bdf", true},
    IntegratorDescriptor{Integrator::adams, "adams", false},
};

/// All integrators that a user can choose, without `automatic`.
inline constexpr auto all_integrators = [] {
  std::array<Integrator, integrator_descriptors.size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = integrator_descriptors[i].integrator;
  return all;
}();

[[nodiscard]] constexpr std::string_view to_string(Integrator integrator) {
  for (const IntegratorDescriptor& d : integrator_descriptors) {
    if (d.integrator == integrator) return d.name;
  }
  return "automatic";
}

[[nodiscard]] constexpr bool is_implicit(Integrator integrator) {
  for (const IntegratorDescriptor& d : integrator_descriptors) {
    if (d.integrator == integrator) return d.implicit;
  }
  return false;
}

}  // namespace softland
