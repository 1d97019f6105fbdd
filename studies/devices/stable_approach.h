// The stable approach: the drive that can carry a switch to its contact through stable equilibria, and the share of devices on
// which it can.
//
// A drive can carry the switch if the static equilibria from rest to the contact plane are stable all the way and within the
// limits of its driver. A piezo is one, and so is an electrode whose contact lies before the fold of its branch. The other
// drives stand still; an electrode that holds the closed switch stands low meanwhile. A slow waveform along such a path closes
// every device at a speed that is the spread of the touching voltages over the remaining time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/watch.h"
#include "studies/closing/actuator.h"
#include "studies/closing/prepared.h"

namespace softland {

struct StableApproach {
  std::string drive;     ///< the drive that carries the contact point
  std::string holder;    ///< electrode that holds the closed switch; empty if `drive` does
  double low = 0;        ///< level of the holder before contact [V]
  double reaches = 0;    ///< commanded voltage of `drive` at which the nominal design touches [V]
  double deviation = 0;  ///< its standard deviation over the devices of the spread, to first order [V]
  double slope = 0;      ///< derivative of the contact point's deflection by that voltage, nominal design [m/V]
  double limit = 0;      ///< limit of the driver on that side [V]

  /// Range of the places, on the way of the nominal design, at which 90 % of the devices touch: from the 5th percentile to the
  /// 95th, to first order [m].
  [[nodiscard]] double touch_places() const;
};

/// The time that a shaper of two impulses takes to bring the switch near its contact without vibration [s].
[[nodiscard]] double shortest_rise(const PreparedScene& nominal);
/// Returns a reference speed for slow approaches that land every device with one waveform [m/s]. The contact point of the
/// nominal design passes the places where 90 % of the devices touch evenly, in the time up to `steady` [s] that the shortest
/// rise leaves. Infinite if it leaves none.
[[nodiscard]] double quasi_static_speed(const StableApproach& approach, const PreparedScene& nominal, double steady);

/// Finds the approach by a drive that a search with this actuator may shape; none if no drive has such a path on the nominal
/// design. Drives without limits carry nothing. The deviation is 0 for a scene without [spread].
[[nodiscard]] std::optional<StableApproach> stable_approach(const PreparedScene& nominal, Actuator actuator);

/// The commanded voltage at which the nominal design touches while the holder stands at `low`; NaN without a path [V].
[[nodiscard]] double touching_voltage(const PreparedScene& nominal, const StableApproach& approach, double low);

/// The share of devices of the spread that have such a path within the limits of the driver.
[[nodiscard]] double share_with_path(const PreparedScene& nominal, const StableApproach& approach, std::uint64_t devices,
                                     std::uint64_t seed, int jobs, const Watch& watch = {});

}  // namespace softland
