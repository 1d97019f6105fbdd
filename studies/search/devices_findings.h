// The findings of a search over varied devices, from which its reports are made: how the found waveforms perform on fresh
// devices (devices that the search has not used), and how they were chosen. The JSON of a search holds all findings
// (reports/closing_members.h), so that a report can be made again.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "objectives/figures.h"
#include "studies/devices/hold_window.h"
#include "studies/search/robust_optimize.h"

namespace softland {

// Names of rows of results; each row belongs to one waveform with which the devices were closed.
inline constexpr const char *plain_step_row = "plain step", *for_the_drawing = "for the drawing",
                            *for_the_devices = "for the devices", *undelayed_row = "electrode at t = 0";
inline constexpr const char* default_choice = "default";  ///< name of the choice whose waveform is in best.toml

/// 95th percentiles and share over the fresh devices under a candidate waveform.
struct FrontPoint {
  double first_touch = Metrics::unset, impact_speed = Metrics::unset;  ///< 95th percentiles [s], [m/s]
  double bounce_free = Metrics::unset;                                 ///< share of bounce-free devices
  std::string candidate;  ///< waveform family and measure of the search: "bspline:6 by cvar:0.9"
};

/// Results on fresh devices if the dynamic pull-in voltage Vdp of each device is measured with an error. Each figure is the
/// best of two: under the waveforms searched with a per-device calibration, and under the best uncalibrated waveform.
struct CalibrationError {
  double error = 0;  ///< relative standard deviation of the measurement error of Vdp
  double bounce_free = Metrics::unset, impact_speed = Metrics::unset;  ///< share of devices; 95th percentile [m/s]
};

/// A candidate waveform from which the search over devices chooses the best one.
struct RaceEntry {
  std::string measure, waveform;  ///< "cvar:0.9", "knots:6"; measure "drawing": from the search on the nominal device
  long closings = 0;
  double bounce_free = 0, cost = 0;  ///< share of bounce-free devices, and cost, on the devices on which the choice is made
};

/// Results of a search over varied devices: the found waveforms on fresh devices, and how they were found.
struct DevicesFindings {
  /// A rebound height below which a device counts for a yield, and its key in JSON.
  struct YieldHeight {
    double height;  ///< rebound height [m]
    const char* key;
  };
  static constexpr std::array yield_heights{YieldHeight{1e-9, "1e-9"}, YieldHeight{1e-8, "1e-8"}, YieldHeight{1e-7, "1e-7"}};

  struct Row {
    std::string name;                                                         ///< "plain step", "for the drawing", "Vdp to 1 %"
    double pull_in_error = Metrics::unset, frequency_error = Metrics::unset;  ///< relative errors; NaN: not measured
    double piezo_error = Metrics::unset;  ///< relative error of the measured deflection by the piezo
    double time_error = Metrics::unset;   ///< measurement error of a closing time [s]
    bool searched_for_it = true;
    double bounce_free = Metrics::unset, open = Metrics::unset, collapsed = Metrics::unset;  ///< shares of the devices
    /// 50th, 95th and 99th percentiles, by key of device_figures; infinite if too many devices do not close.
    std::map<std::string, double> at_50, at_95, at_99;
    std::map<std::string, double> yield;  ///< shares of the devices whose rebound is within yield_heights
  };
  /// A waveform that is offered to the user; row() returns the name of its row of results.
  struct Choice {
    std::string name, file, waveform;
    double tau = Metrics::unset;  ///< time until the contact force is steady, over the same time under the plain step
    [[nodiscard]] std::string row() const { return name == default_choice ? for_the_devices : name; }
  };
  /// How a drive can move the switch to its contact through stable equilibria.
  struct StablePath {
    std::vector<std::string> drives;       ///< names of the drives; the drive that moves the switch to its contact comes first
    double share = Metrics::unset;         ///< share of the devices with a stable path within the drivers' limits
    double reaches = Metrics::unset;       ///< voltage of the first drive at which the nominal design touches [V]
    double limit = Metrics::unset;         ///< limit of the first drive's voltage towards the contact [V]
    double touch_places = Metrics::unset;  ///< range in which 90 % of the devices touch: StableApproach::touch_places() [m]
    double rise = Metrics::unset;          ///< least time before the first device touches its contact [s]
  };
  /// Contact gaps of devices over time, under the plain step and under the waveform of best.toml, at equal time steps.
  struct Courses {
    double end = Metrics::unset;              ///< the last instant [s]
    double unit = Metrics::unset;             ///< unit of the gaps in `step` and `own` [m]
    std::vector<std::vector<int>> step, own;  ///< gaps by device, then by instant [`unit`]
  };

  bool spread_assumed = false;
  std::string spread;  ///< the process variation in words
  double count = Metrics::unset, seed = Metrics::unset, closings = Metrics::unset;
  std::string measure, waveform;  ///< measure and waveform family of the best waveform; empty if the plain step is best
  bool better_than_plain_step = false;
  std::vector<std::string>
      worse_in;  ///< figures in which the best candidate is worse than the plain step, if the plain step is best
  std::vector<Row> rows;
  std::vector<Choice> choices;  ///< choices, that with the earliest steady contact first; empty if the plain step is best
  std::optional<StablePath> stable_path;
  std::optional<bool> goal_met;                ///< true if the 95th percentile of the rebound height under best.toml is not
                                               ///< significant
  double missed_by = Metrics::unset;           ///< excess of the rebounds' 95th percentile over the goal; 0: goal met [m]
  double step_delay = Metrics::unset;          ///< delay of the electrode's plain step, if its instant was searched [s]
  std::optional<Courses> courses;              ///< contact gaps over time; none if the plain step is best
  std::vector<FrontPoint> front;               ///< performance of candidates, sorted by time of first contact
  std::vector<CalibrationError> by_error;      ///< results by measurement error, the least first; none if Vdp is not measured
  HoldWindows windows;                         ///< hold voltages that keep devices closed, by electrode
  std::vector<RaceEntry> race;                 ///< candidates for the best waveform, the best first
  std::vector<FulfilledCondition> conditions;  ///< conditions of the search, and the share of devices that fulfil them under
                                               ///< the best waveform
  FigureValues drawing;                        ///< figures of merit of the nominal design's waveform on the nominal device
  std::string drawing_status;
  bool drawing_goal_met = false;
  std::string measured;  ///< name of the row of results for calibrated.toml; empty without this file
  std::string next_command;

  /// Returns the row of this name, or null.
  [[nodiscard]] const Row* row(std::string_view name) const;
};

}  // namespace softland
