// Derivatives of figures of a switch at rest by parameters of its device, by implicit differentiation.
//
//   F(q, V; p) = 0                      an equilibrium, F static modal accelerations
//   q_p = -F_q^-1 F_p                   at constant voltages, away from a fold
//   [F_q  F_l ] [q_p]     [F_p]         at a constant interference d of the contact point;
//   [d_q   0  ] [l_p] = - [d_p]         l is the strength of the drive that holds this point
//
// Subscripts are derivatives. q are modal coordinates, V the voltages of the drives, p is a parameter.
//
// The pull-in voltage is the largest voltage of the open branch of equilibria, or that at the contact plane; the release
// voltage is the least of the closed branch. V as a function of the interference has no slope at such an extremum, and at the
// plane the interference is 0. In each case V_p at a constant interference is the derivative of the voltage (envelope theorem).
// F_p and the explicit dependence of a figure come from two switches with a smaller and a larger parameter (SwitchSlopes). A
// slope is NaN where the equilibrium does not exist. The functions return one slope for each of SwitchSlopes::moving().
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/pull_in.h"
#include "model/switch_slopes.h"

namespace softland {

/// Returns the derivatives of static_pull_in() by device parameters [V per unit of the parameter]; `pull_in` is its result.
[[nodiscard]] std::vector<double> static_pull_in_slopes(const Switch& model, SwitchSlopes& by, std::size_t drive,
                                                        const StaticPullIn& pull_in, Bias bias = {});
/// Returns the derivatives of the release voltage, release_point(), by device parameters [V per unit of the parameter]; NaN for
/// a release voltage of 0.
[[nodiscard]] std::vector<double> release_slopes(const Switch& model, SwitchSlopes& by, std::size_t drive,
                                                 const ReleasePoint& release, Bias bias = {});

/// Returns the angular frequency of a mode, counted from 0, of small undamped vibrations about the open switch at rest under
/// these values of all drives [rad/s]; NaN when the switch does not rest open. If all values are 0 the result is the frequency
/// of the undeflected switch, Switch::angular_frequencies().
[[nodiscard]] double resonance(const Switch& model, std::size_t mode, std::span<const double> values);
/// Returns the derivatives of resonance(), a vibration frequency, by device parameters [rad/s per unit of the parameter].
[[nodiscard]] std::vector<double> resonance_slopes(const Switch& model, SwitchSlopes& by, std::size_t mode,
                                                   std::span<const double> values);

/// Returns the capacitance of an electrode of the open switch at rest under these values of all drives [F]; NaN when the switch
/// does not rest open.
[[nodiscard]] double open_capacitance(const Switch& model, std::size_t drive, std::span<const double> values);
/// Returns the derivatives of open_capacitance(), an electrode's capacitance at rest, by device parameters [F per unit of the
/// parameter].
[[nodiscard]] std::vector<double> open_capacitance_slopes(const Switch& model, SwitchSlopes& by, std::size_t drive,
                                                          std::span<const double> values);
/// Returns the derivative of open_capacitance(), an electrode's capacitance at rest, by the voltage of drive `moved` [F/V].
[[nodiscard]] double open_capacitance_by_voltage(const Switch& model, std::size_t drive, std::size_t moved,
                                                 std::span<const double> values);
/// Returns the derivative of resonance(), a vibration frequency, by the voltage of drive `moved` [rad/s/V].
[[nodiscard]] double resonance_by_voltage(const Switch& model, std::size_t mode, std::size_t moved,
                                          std::span<const double> values);

}  // namespace softland
