// What `softland robustness` found: JSON with SI units in the names, one line per device as CSV, and a
// document.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/watch.h"
#include "reports/document.h"
#include "reports/result_maker.h"
#include "studies/devices/box_and_chaos.h"
#include "studies/devices/derivatives.h"
#include "studies/devices/hold_window.h"
#include "studies/devices/robustness.h"

namespace softland {

/// What is reported; `sensitivity`, `derivatives` and `courses` are of the last drive and may be left out.
struct RobustnessReport {
  const PreparedScene& nominal;
  const Robustness& found;
  RobustnessOptions options;
  std::string command;          ///< the command line
  bool spread_assumed = false;  ///< the scene says nothing of how devices differ
  Sensitivity sensitivity = {};
  Derivatives derivatives = {};
  std::vector<DeviceCourse> courses = {};
  std::optional<BoxAndChaos> box_and_chaos = {};  ///< of the last drive as well
  HoldWindows windows = {};                       ///< of hold levels, whatever the drive
  std::string unheld = {};                        ///< why the last drive does not hold the nominal device, hold_warning()
  bool interrupted = found.interrupted;           ///< in the study, or in what was to be known beside it
};

/// What is known of the last drive beside its figures, `other_ways_too` at the cost of further searches; nothing where the work
/// was interrupted.
void add_details(RobustnessReport& report, bool other_ways_too, const Watch& watch);

/// Those of the nominal scene, and why the last drive does not hold the nominal device.
[[nodiscard]] std::vector<std::string> warnings(const RobustnessReport& report);

[[nodiscard]] nlohmann::json robustness_json(const RobustnessReport& report);

/// A line per device: its number, the varying quantities [SI unit, or factor; of jitter the time drawn for the first edge], and
/// for every drive its status and figures; a figure that a device does not have is empty.
[[nodiscard]] std::string robustness_csv(const RobustnessReport& report);

/// Statistics, cumulative distributions and histograms, the closings of typical devices, every figure against every quantity,
/// what measuring is worth, where the spread comes from, derivatives at the nominal device, the other ways, the worst devices,
/// failures.
[[nodiscard]] Document robustness_document(const RobustnessReport& report);

namespace internal {

/// [lower, upper] by electrode [V]; null where no level holds as many devices, or an end where there is none.
[[nodiscard]] nlohmann::json windows_json(const HoldWindows& windows);

}  // namespace internal
}  // namespace softland
