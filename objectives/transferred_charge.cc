#include "objectives/transferred_charge.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "integrators/quintic.h"

namespace softland {

void TransferredCharge::follow(const TrajectoryPoint& from, const TrajectoryPoint& to) {
  const double span = to.time - from.time;
  if (!options_.load.is_given() || !(span > 0)) return;
  const double middle = 0.5 * (from.position + to.position) + (from.velocity - to.velocity) * span / 8;
  if (middle < contact_gap_) return;
  // Find the part of the time between the two motion points in which the contact force is below the steady force: only there
  // does the charge count.
  double first = 0, last = 1;  // begin and end of the part with low force, as shares of the time between the points
  const double rise = to.contact_force - from.contact_force;
  if (rise != 0) {
    const double crossing = (options_.light_below - from.contact_force) / rise;
    (rise > 0 ? last : first) = std::clamp(crossing, 0.0, 1.0);
  } else if (!(from.contact_force < options_.light_below)) {
    return;
  }
  if (!(first < last)) return;
  const double voltage = options_.load.voltage, series = options_.load.resistance;
  if (!options_.contact) {
    charge_ += voltage / series * (last - first) * span;
    return;
  }
  const Quintic motion(from.time, from.position, from.velocity, from.acceleration, to.time, to.position, to.velocity,
                       to.acceleration);
  // Nodes of the three-point Gauss-Legendre rule on [0, 1].
  constexpr std::array places{0.5 - 0.3872983346207417, 0.5, 0.5 + 0.3872983346207417};
  constexpr std::array weights{5.0 / 18, 8.0 / 18, 5.0 / 18};
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double share = std::lerp(first, last, places[k]);
    const double conductance = options_.contact->conductance(motion.position(from.time + share * span) - contact_gap_,
                                                             std::lerp(from.contact_force, to.contact_force, share));
    const double current = voltage * conductance / (1 + series * conductance);
    charge_ += current * weights[k] * (last - first) * span;
  }
}

double TransferredCharge::charge() const { return options_.light_below > 0 ? charge_ : std::numeric_limits<double>::quiet_NaN(); }

}  // namespace softland
