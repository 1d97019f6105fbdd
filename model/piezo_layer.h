// The capacitance of a piezoelectric layer, which its source has to charge.
//
//   C = eps0 eps_r w (Lp2 - Lp1) / b_p
//
// C is the capacitance [F]; eps_r the relative permittivity of the layer between its electrodes; w the width of the beam and
// the layer [m]; Lp1, Lp2 begin and end of the layer [m]; b_p its thickness [m]. On a beam of sections w (Lp2 - Lp1) is the
// area of the layer. The formula neglects edges and holds at constant strain. The charge by the motion of the beam is
// ModalBasis::piezo_charge(); the model of the drives and all energies already include it.
//
// The capacitor stores energy and dissipates none, so it does not affect the motion. Its source has to supply the energy: C
// V^2/2 for every rise from 0 V to V. The usual amplifier dissipates the energy that comes back when the voltage falls, so
// nothing is subtracted.
#pragma once

#include <span>

#include "model/device.h"
#include "waveforms/signal.h"

namespace softland {

/// Returns the capacitance of the piezo layer [F]; NaN without a layer, or when the scene does not give its relative
/// permittivity.
[[nodiscard]] double layer_capacitance(const Device& device);

/// Returns the energy that charging the piezo layer takes from its source on [0, end] [J]; this source is the last of the
/// drives (Switch::drives()). The energy is 0 when layer_capacitance() is NaN.
[[nodiscard]] double layer_charging_energy(const Device& device, std::span<const Signal> drives, double end);

}  // namespace softland
