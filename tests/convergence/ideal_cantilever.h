// The ideal cantilever of the literature on pull-in: one electrode, no gas, no contact, no fringing.
#pragma once

#include <cmath>

#include "base/literals.h"
#include "model/constants.h"
#include "model/device.h"

namespace softland::test {

inline constexpr int converged_modes = 12;  // Galerkin error below 1e-9

struct IdealCantilever {
  int modes = 4;
  Fringing fringing = Fringing::none;
  double gap_over_width = 0.1;
  double electrode_begin = 0;      ///< beginning of the electrode over the length
  double electrode_end = 1;        ///< end of the electrode over the length
  double contact_over_gap = 0.97;  ///< tip deflection over the gap at which a run counts as closed
};

/// Returns a device with these ratios. Its absolute dimensions cancel in every dimensionless figure.
[[nodiscard]] inline Device device(const IdealCantilever& ideal) {
  using namespace literals;
  constexpr double length = 1000_um, gap = 2_um;
  return {.structure = {.length = length,
                        .width = gap / ideal.gap_over_width,
                        .thickness = 3_um,
                        .modes = ideal.modes,
                        .kind = Cantilever{{.youngs_modulus = 100_GPa, .density = 2000_kg_m3}}},
          .gap = {.electrode = gap, .contact = ideal.contact_over_gap * gap},
          .electrodes = {{.name = "ideal",
                          .begin = ideal.electrode_begin * length,
                          .end = ideal.electrode_end * length,
                          .fringing = ideal.fringing}}};
}

/// Returns beta = eps0 a V^2 L^4 / (2 E I g^3), the voltage parameter of the literature.
[[nodiscard]] inline double beta(const Device& d, double volts) {
  const Structure& s = d.structure;
  const double rigidity = part_of<Beam>(s).youngs_modulus * s.width * std::pow(s.thickness, 3) / 12;
  return vacuum_permittivity * s.width * volts * volts * std::pow(s.length, 4) / (2 * rigidity * std::pow(d.gap.electrode, 3));
}

/// Returns the voltage for a value of beta().
[[nodiscard]] inline double volts(const Device& d, double beta_value) { return std::sqrt(beta_value / beta(d, 1)); }

/// Value of beta at static pull-in with a full-length electrode without fringing, from an independent program: Green's function
/// with displacement control.
inline constexpr double full_length_beta = 1.680841;
inline constexpr double full_length_tip = 0.446536;  // tip deflection over the gap at static pull-in

}  // namespace softland::test
