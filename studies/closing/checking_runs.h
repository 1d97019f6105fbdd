// Repeated simulations that confirm a closing: with a tighter integrator, with more modes, and under other gas laws.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/closing/simulate.h"

namespace softland {

/// Tolerance of the integrator in a run that confirms another.
inline constexpr double tight_tolerance = 1e-9;

/// The difference of a repeated simulation from the closing that it confirms.
enum class Varied { integrator, modes, gas };

/// One way of simulating a closing again, as a switch and a tolerance.
struct OtherWay {
  std::string name;  ///< "tolerance 1e-9", "modes 6", "gas veijola"
  Varied varied = Varied::integrator;
  Device device;
  double tolerance = 0;
};

struct CheckingRun {
  std::string name;  ///< name of the way
  Varied varied = Varied::integrator;
  Metrics metrics;
};

/// Returns the device with two, four and six more modes, as far as possible; none for a plate, which has one mode.
[[nodiscard]] std::vector<Device> with_more_modes(const Device& device);
/// Returns the quadrature for `device`, which has more modes than `quadrature` was chosen for.
[[nodiscard]] SwitchOptions quadrature_of_richer(SwitchOptions quadrature, const Device& device);

/// Returns a simulation with a tighter integrator, then one with each larger number of modes.
[[nodiscard]] std::vector<OtherWay> other_numerics(const PreparedScene& closing);
/// Returns a simulation under each of the gas laws strip, veijola and gallis-torczynski, without the scene's own law and those
/// that the scene cannot have. None if its gas is a damper, and without gas.
[[nodiscard]] std::vector<OtherWay> other_gas_laws(const PreparedScene& closing);

/// Simulates the closing in another way.
[[nodiscard]] CheckingRun simulated(const PreparedScene& closing, const OtherWay& way);
/// Simulates the closing in every other way. A run under another gas law is left out if it leaves the limits of that law.
[[nodiscard]] std::vector<CheckingRun> run_checks(const PreparedScene& closing);

}  // namespace softland
