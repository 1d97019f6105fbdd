// The results of `softland check` about a scene: JSON with SI units in the names, lines for a terminal, and a
// drawing of the beam.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "model/device.h"
#include "reports/pull_in_report.h"
#include "studies/closing/closed_state.h"

namespace softland {

struct CheckRecord {
  struct Line {
    std::string name, value;
  };
  /// The rest shape of a structure that is not straight at rest. A rise is the distance from the straight shape, positive away
  /// from the electrodes below the structure.
  struct Rest {
    double far_end_rise = Metrics::unset;  ///< rise of the far end of the structure above its straight shape [m]
    double far_end_gap = Metrics::unset;   ///< distance of the structure's far end to the plane of the electrode [m]
    double contact_rise = Metrics::unset;  ///< rise of the structure, above its straight shape, at contact number one [m]
    double contact_gap = Metrics::unset;   ///< distance of the structure to the plane of contact number one [m]
    double least_gap = Metrics::unset;     ///< smallest gap between the structure and the electrodes below it [m]
  };
  Origin origin;
  std::string file;  ///< name of the scene file as the user gave it
  std::string title;
  std::vector<double> frequencies;  ///< natural angular frequencies of the structure [rad/s]
  std::optional<Rest> rest_shape;   ///< shape of the structure at rest; not set for a straight structure
  /// Pull-in voltages by electrode; a single electrode read from JSON has an empty name.
  std::map<std::string, PullInRecord> pull_in;
  /// Per electrode: release voltage, and voltage at which the closed structure collapses onto the electrode [V].
  std::map<std::string, std::array<double, 2>> hold_windows;
  double dynamic_precision = Metrics::unset;  ///< relative precision to which dynamic pull-in voltages were searched
  std::optional<ClosedState> closed_state;
  std::optional<StablePathRecord> stable_path;
  /// Length of the simulated time [s]; relative tolerance of the integrator.
  double duration = Metrics::unset, tolerance = Metrics::unset;
  std::vector<std::string> warnings;
  std::vector<Line> lines;  ///< numbers derived from the scene, with their names, as text
};

/// Names the members of the JSON.
void members(internal::Archive& a, CheckRecord& record);
[[nodiscard]] nlohmann::json json_of(const CheckRecord& record);
[[nodiscard]] CheckRecord read_check(const nlohmann::json& from);
[[nodiscard]] std::string text_of(const CheckRecord& record);

/// Returns a static SVG document of the beam at rest, to scale along its length; the device must have a beam. The view from above
/// is to scale across the beam too, if that fits. The view from the side enlarges heights. Both views show sections, layers,
/// anchors, electrodes and contacts, with the names of the last three and of the piezo layer; the view from above also shows
/// holes.
[[nodiscard]] std::string beam_drawing(const std::string& title, const Device& device);

}  // namespace softland
