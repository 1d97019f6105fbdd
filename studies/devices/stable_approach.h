// The stable approach: a drive moves the contact point to the contact through stable equilibria. The functions of this file
// find the drive, and the share of devices that this drive can move so.
//
// A drive has a path of stable equilibria if all static equilibria from rest to the contact plane are stable and within the
// limits of its voltage source. A piezo may have such a path, and so may an electrode whose contact plane comes before the
// pull-in instability. The other drives are constant. An electrode that holds the closed switch is at a low level until
// contact. A slow waveform along the path closes every device. Its impact velocity is the width of the range of positions at
// which devices touch, divided by the available time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/progress.h"
#include "studies/closing/actuator.h"
#include "studies/closing/prepared.h"

namespace softland {

struct StableApproach {
  std::string drive;     ///< drive that moves the contact point
  std::string holder;    ///< electrode that holds the closed switch; empty if `drive` holds it
  double low = 0;        ///< level of the electrode `holder` before contact [V]
  double reaches = 0;    ///< commanded voltage of `drive` at which the nominal design touches its contact [V]
  double deviation = 0;  ///< standard deviation of `reaches` over the varied devices, to first order [V]; 0 without [spread]
  double slope = 0;      ///< derivative of the contact point's deflection by the voltage of `drive` on the nominal design [m/V]
  double limit = 0;      ///< limit of the voltage source in the direction of `reaches` [V]

  /// Returns the range of voltages at which the devices touch, from the 5th to the 95th percentile, as a range of positions of
  /// the nominal design's contact point, to first order [m].
  [[nodiscard]] double touch_places() const;
};

/// Returns the shortest time in which a two-impulse input shaper brings the switch near its contact without vibration [s].
[[nodiscard]] double shortest_rise(const PreparedScene& nominal);
/// Returns a reference speed for slow approaches that close every device without a bounce with one waveform [m/s]:
/// touch_places() divided by the time between the shortest rise and `steady`, when the contact must be steady [s]. The contact
/// point passes the touching positions at this constant speed. Infinite if no time is left.
[[nodiscard]] double quasi_static_speed(const StableApproach& approach, const PreparedScene& nominal, double steady);

/// Finds a stable approach by a drive that a search with this actuator may vary; none if no drive has a path of stable
/// equilibria to contact on the nominal design. Drives without limits are not considered.
[[nodiscard]] std::optional<StableApproach> stable_approach(const PreparedScene& nominal, Actuator actuator);

/// Returns the commanded voltage of `approach.drive` at which the nominal design touches its contact while the electrode
/// `holder` is at `low` [V]; NaN if there is no path of stable equilibria to the contact.
[[nodiscard]] double touching_voltage(const PreparedScene& nominal, const StableApproach& approach, double low);

/// Returns the share of the devices of [spread] that have a stable path to contact within the limits of the voltage source.
[[nodiscard]] double share_with_path(const PreparedScene& nominal, const StableApproach& approach, std::uint64_t devices,
                                     std::uint64_t seed, int jobs, const Progress& progress = {});

}  // namespace softland
