// The motion of a switch in a closing as a picture of it needs it: all modes, at instants close enough for straight lines.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/closing/simulate.h"

namespace softland {

/// The lower face at x and time t lies at the height rest(x) - sum over modes of amplitude_i(t) shape_i(x), from where a straight
/// structure has it at rest. Motion towards the near electrode is positive.
struct ShownMotion {
  struct Contact {
    std::string name;  ///< may be empty where there is one
    double at = 0;     ///< [m]
    double gap = 0;    ///< rest distance of its place to its plane [m]
    bool far_side = false;
  };
  struct Pad {
    std::string electrode;
    double begin = 0, end = 0;  ///< [m]
    double gap = 0;             ///< rest distance of its face to a straight structure [m]
    bool far_side = false;
  };
  std::vector<double> time;                     ///< rises [s]
  std::vector<std::vector<double>> amplitudes;  ///< a list for each mode, at these times: its largest deflection [m]
  std::vector<double> places;                   ///< x, those of the contacts among them [m]
  std::vector<double> rest;                     ///< one for each place [m]
  std::vector<std::vector<double>> shapes;      ///< a list for each mode, at these places; the largest size is 1
  std::vector<Contact> contacts;
  std::vector<Pad> electrodes;
};

/// Instants of a motion, and modes times instants, at the most.
inline constexpr std::size_t most_instants = 2000, most_amplitudes = 24'000;

/// Runs the closing once more to see its modes. The first and the last instant are kept, those at which a touch or one of the
/// highest rebounds begins, is highest or ends, and between them those that straight lines miss by the most. None where the
/// run did not come to its end.
[[nodiscard]] std::optional<ShownMotion> shown_motion(const PreparedScene& prepared, const Closing& closing);

}  // namespace softland
