// The results of `softland check` about a scene: JSON with SI units in the names, and lines for a terminal.
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
  /// The rest shape of a structure that is not straight at rest. A rise is measured from the straight shape, away from the
  /// electrodes of the near side.
  struct Rest {
    double far_end_rise = Metrics::unset;  ///< rise of the far end [m]
    double far_end_gap = Metrics::unset;   ///< distance of the far end to the plane of the electrode [m]
    double contact_rise = Metrics::unset;  ///< rise of the structure at the first contact [m]
    double contact_gap = Metrics::unset;   ///< distance of the structure at the first contact to the contact plane [m]
    double least_gap = Metrics::unset;     ///< smallest gap over the electrodes of the near side [m]
  };
  Origin origin;
  std::string file;  ///< name of the file as the user gave it
  std::string title;
  std::vector<double> frequencies;              ///< natural angular frequencies [rad/s]
  std::optional<Rest> rest_shape;               ///< rest shape; not set for a straight structure
  std::map<std::string, PullInRecord> pull_in;  ///< pull-in voltages by electrode; from JSON, the name of a single electrode is
                                                ///< empty
  std::map<std::string, std::array<double, 2>> hold_windows;  ///< release voltage and voltage of collapse onto the electrode [V]
  double dynamic_precision = Metrics::unset;                  ///< relative precision of dynamic pull-in voltages
  std::optional<ClosedState> closed_state;
  std::optional<StablePathRecord> stable_path;
  double duration = Metrics::unset, tolerance = Metrics::unset;  ///< simulated time [s]; tolerance of the integrator
  std::vector<std::string> warnings;
  std::vector<Line> lines;  ///< derived numbers with their names, as text
};

[[nodiscard]] nlohmann::json json_of(const CheckRecord& record);
[[nodiscard]] CheckRecord read_check(const nlohmann::json& from);
[[nodiscard]] std::string text_of(const CheckRecord& record);

}  // namespace softland
