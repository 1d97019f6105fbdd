// What `softland check` tells of a scene: JSON with SI units in the names, and lines for a terminal.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reports/pull_in_report.h"
#include "studies/closing/closed_state.h"

namespace softland {

struct CheckRecord {
  struct Line {
    std::string name, value;
  };
  /// How a structure that is not straight rests. A rise counts from the straight shape, away from the near electrode.
  struct Rest {
    double far_end_rise = Metrics::unset;  ///< rise of the far end [m]
    double far_end_gap = Metrics::unset;   ///< distance of the far end to the plane of the electrode [m]
    double contact_rise = Metrics::unset;  ///< rise of the first contact's place [m]
    double contact_gap = Metrics::unset;   ///< distance of that place to the contact's plane [m]
    double least_gap = Metrics::unset;     ///< smallest gap over the near electrodes [m]
  };
  Origin origin;
  std::string file;  ///< how the user named it
  std::string title;
  std::vector<double> frequencies;                            ///< [rad/s]
  std::optional<Rest> rest_shape;                             ///< unset of a straight structure
  std::map<std::string, PullInRecord> pull_in;                ///< by electrode that has one; without a name where it is read
  std::map<std::string, std::array<double, 2>> hold_windows;  ///< release and pulled-through voltage [V]
  double dynamic_precision = Metrics::unset;                  ///< relative, of dynamic pull-in voltages
  std::optional<ClosedState> closed_state;
  std::optional<StablePathRecord> stable_path;
  double duration = Metrics::unset, tolerance = Metrics::unset;  ///< [s]; of the integrator
  std::vector<std::string> warnings;
  std::vector<Line> lines;  ///< derived numbers, in words
};

[[nodiscard]] nlohmann::json json_of(const CheckRecord& record);
[[nodiscard]] CheckRecord read_check(const nlohmann::json& from);
[[nodiscard]] std::string text_of(const CheckRecord& record);

}  // namespace softland
