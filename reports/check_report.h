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
  Origin origin;
  std::string file;  ///< how the user named it
  std::string title;
  std::vector<double> frequencies;                            ///< [rad/s]
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
