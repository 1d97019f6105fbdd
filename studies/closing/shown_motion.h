// The motion of a switch in a closing, for an animation: the amplitudes of all modes, at times between which they are linear.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/closing/simulate.h"

namespace softland {

/// At position x and time t the lower face of the beam is at the height rest(x) - sum over modes of amplitude_i(t) shape_i(x).
/// Heights are measured from the lower face of a straight structure at rest. Deflection towards the near side is positive.
struct ShownMotion {
  struct Contact {
    std::string name;  ///< name of the contact; may be empty if there is one contact
    double at = 0;     ///< position of the contact along the structure [m]
    double gap = 0;    ///< rest distance of the contact to its contact plane [m]
    bool far_side = false;
  };
  struct Pad {
    std::string electrode;
    double begin = 0, end = 0;  ///< begin and end of the electrode along the structure [m]
    double gap = 0;             ///< rest distance of the electrode's face to a straight structure [m]
    bool far_side = false;
  };
  std::vector<double> time;                     ///< increasing times of the recorded motion [s]
  std::vector<std::vector<double>> amplitudes;  ///< largest deflection of each mode at each time [m]: its amplitude
  std::vector<double> places;  ///< positions x along the structure at which shapes are given, contacts included [m]
  /// Height of the lower face of the beam at rest, at each of the positions `places` [m].
  std::vector<double> rest;
  std::vector<std::vector<double>> shapes;  ///< shape of each mode at the positions `places`, scaled to a largest size of 1
  std::vector<Contact> contacts;
  std::vector<Pad> electrodes;
};

/// Largest number of instants, and largest product of the numbers of modes and instants, in a recorded ShownMotion.
inline constexpr std::size_t most_instants = 2000, most_amplitudes = 24'000;

/// Simulates the closing once more to record its modes. The recorded instants are the first and the last instant, the
/// beginning, the end and the extreme of touches and of the highest rebounds, and between these the instants at which linear
/// interpolation has the largest error. None if the run is not complete.
[[nodiscard]] std::optional<ShownMotion> shown_motion(const PreparedScene& prepared, const Closing& closing);

}  // namespace softland
