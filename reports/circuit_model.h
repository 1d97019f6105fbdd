// The switch becomes a part of a circuit: behavioural sources for SPICE, or a module in Verilog-A.
//
//   tau dY_i/dt = U_i      tau dU_i/dt = -(tau omega_i)^2 Y_i - 2 zeta tau omega_i U_i + forces      tau = 1 / omega_1
//
// Y_i = q_i phi_1(x_c) / d_t is a modal coordinate over the contact gap d_t, about 1 where the switch closes. A capacitor of
// tau farad holds each of them. The local gap at every quadrature point is a sum of them. The load there is a formula of gap,
// velocity and the voltages of the drives; the charge of an electrode is its capacitance times its voltage. The laws are those
// of a run: their own code gives their formulas (reports/formula.h). Below a hundredth of the rest gap, loads are those at a
// hundredth.
#pragma once

#include <string>
#include <vector>

#include "studies/closing/prepared.h"

namespace softland {

/// Returns the names of the pins of these drives, in the order of the drives. Letters become lower case; a character that is
/// neither letter nor digit becomes an underscore. A name begins with "drive_" where the model uses it itself, SPICE or
/// Verilog-A reserve it, or it cannot begin a name. A name that another drive has ends with a number.
[[nodiscard]] std::vector<std::string> circuit_pins(const std::vector<std::string>& drives);
/// Names the pin of each drive whose pin has another name: "drive g is the pin drive_g".
[[nodiscard]] std::vector<std::string> renamed_pins(const std::vector<std::string>& drives);

/// Says why this switch has no circuit model: "a dielectric on an electrode and several contacts". It lists all parts that have
/// a memory, states or tables of their own, or that pull; empty where a model is possible.
[[nodiscard]] std::string why_no_circuit(const Switch& model);

/// Returns `.subckt softland_switch` with the drives, their ground g, the contact s and d, and outputs y [um], vel [m/s], force
/// [uN]. Throws InvalidInput where the switch has no such model.
[[nodiscard]] std::string spice_model(const PreparedScene& prepared);
/// Returns a whole file for ngspice: the same with the sources of the scene, the options that it takes, and measurements.
[[nodiscard]] std::string spice_bench(const PreparedScene& prepared);
/// Returns the same switch as a module in Verilog-A.
[[nodiscard]] std::string verilog_a(const PreparedScene& prepared);

}  // namespace softland
