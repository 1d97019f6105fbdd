// The other ways in which a closing is simulated to confirm it: by a tighter integrator, with richer beams, under other gas
// laws.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/closing/simulate.h"

namespace softland {

/// Tolerance of the integrator in a run that confirms another.
inline constexpr double tight_tolerance = 1e-9;

/// The difference of another way of simulating.
enum class Varied { integrator, modes, gas };

/// A switch for simulating a closing again.
struct OtherWay {
  std::string name;  ///< "tolerance 1e-9", "modes 6", "gas veijola"
  Varied varied = Varied::integrator;
  Device device;
  double tolerance = 0;
};

struct ConfirmingRun {
  std::string name;  ///< name of the way
  Varied varied = Varied::integrator;
  Metrics metrics;
};

/// The device with two, four and six modes more, as far as possible; none for a plate, which has one mode.
[[nodiscard]] std::vector<Device> with_more_modes(const Device& device);
/// Returns the quadrature for a `device` with more modes than it was chosen for.
[[nodiscard]] SwitchOptions quadrature_of_richer(SwitchOptions quadrature, const Device& device);

/// Returns a tighter integrator, then every richer beam.
[[nodiscard]] std::vector<OtherWay> other_numerics(const PreparedScene& closing);
/// Returns the laws strip, veijola and gallis-torczynski, without the scene's own and those that it cannot have. None if its
/// gas is a damper, or without gas.
[[nodiscard]] std::vector<OtherWay> other_gas_laws(const PreparedScene& closing);

/// Simulates the closing in another way.
[[nodiscard]] ConfirmingRun simulated(const PreparedScene& closing, const OtherWay& way);
/// Simulates the closing in every other way; under gas laws only if it keeps their limits.
[[nodiscard]] std::vector<ConfirmingRun> confirm(const PreparedScene& closing);

}  // namespace softland
