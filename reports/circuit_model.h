// The switch as a part of a circuit: behavioural sources for SPICE, or a module in Verilog-A.
//
//   tau dY_i/dt = U_i      tau dU_i/dt = -(tau omega_i)^2 Y_i - 2 zeta tau omega_i U_i + forces      tau = 1 / omega_1
//
// Y_i = q_i phi_1(x_c) / d_t: modal coordinates over the contact gap d_t, about 1 where the switch closes. A capacitor of tau
// farad holds each of them; the local gap at every quadrature point is a sum of them, the load there a formula of gap, velocity
// and the voltages of the drives, and the charge of an electrode its capacitance times its voltage. The laws are those of a run:
// their formulas are what their own code gives (reports/formula.h). Below a hundredth of the rest gap loads are those at it.
#pragma once

#include <string>
#include <vector>

#include "studies/closing/prepared.h"

namespace softland {

/// What the pins of these drives are called: letters become lower case, what is neither letter nor digit an underscore. A name
/// that the model uses itself, that SPICE or Verilog-A reserve, or that cannot begin a name, begins with "drive_"; one that
/// another drive has ends with a number. They are in the order of the drives.
[[nodiscard]] std::vector<std::string> circuit_pins(const std::vector<std::string>& drives);
/// Says of each drive whose pin has another name what that is: "drive g is the pin drive_g".
[[nodiscard]] std::vector<std::string> renamed_pins(const std::vector<std::string>& drives);

/// Why this switch cannot be written so: "a dielectric on an electrode and several contacts", all that has a memory, states or
/// tables of its own, or that pulls; empty where it can.
[[nodiscard]] std::string why_no_circuit(const Switch& model);

/// `.subckt softland_switch` with the drives, their ground g, the contact s and d, and outputs y [um], vel [m/s], force [uN].
/// Throws InvalidInput where there is no such model.
[[nodiscard]] std::string spice_model(const PreparedScene& prepared);
/// The same with what the sources of the scene give, the options that it takes, and measurements: a whole file for ngspice.
[[nodiscard]] std::string spice_bench(const PreparedScene& prepared);
/// The same switch as a module in Verilog-A.
[[nodiscard]] std::string verilog_a(const PreparedScene& prepared);

}  // namespace softland
