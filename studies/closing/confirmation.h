// The other ways in which a closing is simulated before it is believed: by a tighter integrator, with richer beams, under other
// gas laws.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/closing/simulate.h"

namespace softland {

/// Of the integrator, in a run that confirms another.
inline constexpr double tight_tolerance = 1e-9;

/// What another way of simulating differs in.
enum class Varied { integrator, modes, gas };

/// A switch to simulate a closing with again.
struct OtherWay {
  std::string name;  ///< "tolerance 1e-9", "modes 6", "gas veijola"
  Varied varied = Varied::integrator;
  Device device;
  double tolerance = 0;
};

struct ConfirmingRun {
  std::string name;  ///< of the way
  Varied varied = Varied::integrator;
  Metrics metrics;
};

/// The device with two, four and six modes more, as far as there may be so many; none of a plate, which has one mode.
[[nodiscard]] std::vector<Device> with_more_modes(const Device& device);
/// Where `device` has more modes than what a quadrature was chosen for.
[[nodiscard]] SwitchOptions quadrature_of_richer(SwitchOptions quadrature, const Device& device);

/// A tighter integrator, then every richer beam.
[[nodiscard]] std::vector<OtherWay> other_numerics(const PreparedScene& closing);
/// Those of the laws strip, veijola and gallis-torczynski that the scene does not have and could have; none where its gas is a
/// damper, or there is none.
[[nodiscard]] std::vector<OtherWay> other_gas_laws(const PreparedScene& closing);

/// The same closing in another way.
[[nodiscard]] ConfirmingRun simulated(const PreparedScene& closing, const OtherWay& way);
/// The same closing in every other way; of gas laws only those whose limits it keeps.
[[nodiscard]] std::vector<ConfirmingRun> confirm(const PreparedScene& closing);

}  // namespace softland
