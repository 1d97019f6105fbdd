// Repeated simulations that confirm a closing: with a tighter integrator, with more modes, and under other gas laws.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/closing/simulate.h"

namespace softland {

/// Relative tolerance of the integrator in a run that confirms another run.
inline constexpr double tight_tolerance = 1e-9;

/// The property that differs in a repeated run that confirms a closing: the integrator, the number of modes or the gas law.
enum class Varied { integrator, modes, gas };

/// A switch and a relative tolerance of the integrator with which a closing is simulated again.
struct OtherWay {
  std::string name;  ///< name of the changed setting: "tolerance 1e-9", "modes 6", "gas veijola"
  Varied varied = Varied::integrator;
  Device device;
  double tolerance = 0;
};

struct CheckingRun {
  std::string name;  ///< name of the changed setting: OtherWay::name
  Varied varied = Varied::integrator;
  Metrics metrics;
};

/// Returns the device with two, four and six more modes, up to the largest number of modes; none for a plate, which has one
/// mode.
[[nodiscard]] std::vector<Device> with_more_modes(const Device& device);
/// Returns the quadrature for `device`, which has more modes than the device for which `quadrature` was chosen.
[[nodiscard]] SwitchOptions quadrature_of_richer(SwitchOptions quadrature, const Device& device);

/// Returns settings for repeating a closing: first a tighter integrator, then each larger number of modes.
[[nodiscard]] std::vector<OtherWay> other_numerics(const PreparedScene& closing);
/// Returns a setting for each of the gas laws strip, veijola and gallis-torczynski, without the scene's own law and the laws
/// that are impossible for the scene. None if the gas is a linear damper, or if there is no gas.
[[nodiscard]] std::vector<OtherWay> other_gas_laws(const PreparedScene& closing);

/// Simulates the closing again with the switch and the tolerance of `way`.
[[nodiscard]] CheckingRun simulated(const PreparedScene& closing, const OtherWay& way);
/// Simulates the closing with every other numerical setting and gas law. A run is left out if it leaves the limits of its gas
/// law.
[[nodiscard]] std::vector<CheckingRun> run_checks(const PreparedScene& closing);

}  // namespace softland
