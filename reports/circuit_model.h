// Makes a circuit model of the switch: behavioural sources for SPICE, or a module in Verilog-A.
//
//   tau dY_i/dt = U_i      tau dU_i/dt = -(tau omega_i)^2 Y_i - 2 zeta tau omega_i U_i + forces      tau = 1 / omega_1
//
// Y_i = q_i phi_1(x_c) / d_t is the scaled coordinate of mode i, and U_i its scaled velocity. The symbol q_i is the modal
// coordinate, phi_1(x_c) the first mode shape at the contact, d_t the contact gap, zeta the damping ratio. Y_1 is about 1 when
// the switch closes. A capacitor of tau farad holds each Y_i and U_i. The local gap at a quadrature point is a sum over the
// Y_i. The load at that point is a formula of gap, velocity and voltages of the electrodes; the charge of an electrode is its
// capacitance times its voltage. Formulas come from the simulator's own code of the laws (reports/formula.h). Where the local
// gap is below a hundredth of the electrode's rest gap, the load has its value at that hundredth, so that it stays finite.
#pragma once

#include <string>
#include <vector>

#include "studies/closing/prepared.h"

namespace softland {

/// Returns the names of the pins for these drives (electrodes, piezos, dispersion force), in the same order. Letters become
/// lower case; a character that is neither letter nor digit becomes an underscore. A name gets the prefix "drive_" if the model
/// uses the name itself, if SPICE or Verilog-A reserve it, or if it cannot begin a name. A name that another drive has already
/// gets a number at its end.
[[nodiscard]] std::vector<std::string> circuit_pins(const std::vector<std::string>& drives);
/// Returns a text for each drive (electrode, piezo or dispersion force) whose pin has another name: "drive g is the pin
/// drive_g".
[[nodiscard]] std::vector<std::string> renamed_pins(const std::vector<std::string>& drives);

/// Returns the reason why this switch has no circuit model: "a dielectric on an electrode and several contacts". The text lists
/// all parts that a circuit model cannot describe; it is empty if there is a model.
[[nodiscard]] std::string why_no_circuit(const Switch& model);

/// Returns the circuit `.subckt softland_switch` with pins for electrodes, piezos and dispersion force, their ground g, the
/// contact s and d, and outputs y [um], vel [m/s], force [uN]. Throws InvalidInput for a switch without a circuit model: see
/// why_no_circuit().
[[nodiscard]] std::string spice_model(const PreparedScene& prepared);
/// Returns a complete file for ngspice: the model of spice_model(), sources with the waveforms of the scene, options, and
/// measurements.
[[nodiscard]] std::string spice_bench(const PreparedScene& prepared);
/// Returns the model of the switch as a module in Verilog-A. Throws the exceptions of spice_model().
[[nodiscard]] std::string verilog_a(const PreparedScene& prepared);

}  // namespace softland
