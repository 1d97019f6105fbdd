// The capacitor that a piezoelectric layer is for its source.
//
//   C = eps0 eps_r w (Lp2 - Lp1) / b_p
//
// C capacitance [F]; eps_r relative permittivity of the layer between its
// electrodes; w width of the beam, which the layer has [m]; Lp1, Lp2 begin and end of the layer [m]; b_p its thickness [m]. On a
// beam of sections w (Lp2 - Lp1) is the area of the layer. The formula leaves out edges and holds at constant strain: the charge
// that the motion of the beam moves is ModalBasis::piezo_charge(), which drives and energies have anyway.
//
// The capacitor stores energy and dissipates none, so it has no part in the motion. It does take a source that supplies it: C
// V^2/2 for every rise from 0 V to V. The usual amplifier dissipates what comes back when the voltage falls, so nothing is taken
// off.
#pragma once

#include <span>

#include "model/device.h"
#include "waveforms/signal.h"

namespace softland {

/// [F]; NaN without a layer, or where the scene does not give its relative permittivity.
[[nodiscard]] double layer_capacitance(const Device& device);

/// What charging the layer takes of the source of the piezo on [0, end], that source being the last of the drives
/// (Switch::drives()) [J]; 0 where layer_capacitance() is not known.
[[nodiscard]] double layer_charging_energy(const Device& device, std::span<const Signal> drives, double end);

}  // namespace softland
