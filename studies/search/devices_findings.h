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

// Names of rows of results; each row belongs to one waveform and its closings on the devices.
inline constexpr const char *plain_step_row = "plain step", *for_the_drawing = "for the drawing",
                            *for_the_devices = "for the devices", *undelayed_row = "electrode at t = 0";
/// Name of the choice offered to the user whose waveform is in best.toml.
inline constexpr const char* default_choice = "default";

/// 95th percentiles and bounce-free share over the fresh devices (new to the search) under a candidate waveform.
struct FrontPoint {
  /// 95th percentiles of the first contact time [s] and of the impact velocity [m/s].
  double first_touch = Metrics::unset, impact_speed = Metrics::unset;
  double bounce_free = Metrics::unset;  ///< share of bounce-free devices under the candidate waveform
  std::string candidate;  ///< waveform family, and measure of risk that the search minimised: "bspline:6 by cvar:0.9"
};

/// Results on fresh devices (new to the search) if the dynamic pull-in voltage Vdp of each device is measured with an error.
/// Each figure is the best of two: under the waveforms searched with a per-device calibration, and under the best uncalibrated
/// waveform.
struct CalibrationError {
  double error = 0;  ///< relative standard deviation of the measurement error of Vdp
  /// Share of bounce-free devices; 95th percentile of the impact velocity [m/s].
  double bounce_free = Metrics::unset, impact_speed = Metrics::unset;
};

/// A candidate waveform from which the search over devices chooses the best one.
struct RaceEntry {
  /// Minimised measure of risk and waveform family: "cvar:0.9", "knots:6"; measure "drawing": from the search on the nominal
  /// device.
  std::string measure, waveform;
  long closings = 0;
  /// Share of bounce-free devices, and cost of the candidate waveform, on the devices on which the best one is chosen.
  double bounce_free = 0, cost = 0;
};

/// Results of a search over varied devices: the found waveforms on fresh devices (new to the search), and how they were found.
struct DevicesFindings {
  /// A rebound height below which a device counts for the yield, and the key of this yield in JSON.
  struct YieldHeight {
    double height;  ///< limit of the rebound height [m]
    const char* key;
  };
  static constexpr std::array yield_heights{YieldHeight{1e-9, "1e-9"}, YieldHeight{1e-8, "1e-8"}, YieldHeight{1e-7, "1e-7"}};

  struct Row {
    std::string name;  ///< name of the row of results: "plain step", "for the drawing", "Vdp to 1 %"
    /// Relative errors of the measured Vdp and frequency; NaN: not measured.
    double pull_in_error = Metrics::unset, frequency_error = Metrics::unset;
    double piezo_error = Metrics::unset;  ///< relative error of the measured deflection by the piezo
    double time_error = Metrics::unset;   ///< standard deviation of the error of a measured closing time [s]
    bool searched_for_it = true;
    /// Shares of the devices that are bounce-free, that stay open, and that collapse onto the electrode.
    double bounce_free = Metrics::unset, open = Metrics::unset, collapsed = Metrics::unset;
    /// 50th, 95th and 99th percentiles of figures, by key of device_figures; infinite if too many devices do not close.
    std::map<std::string, double> at_50, at_95, at_99;
    /// Shares of the devices whose highest rebound is within a height of yield_heights, by key.
    std::map<std::string, double> yield;
  };
  /// A waveform that is offered to the user; row() returns the name of its row of results.
  struct Choice {
    std::string name, file, waveform;
    double tau = Metrics::unset;  ///< time until the contact force is steady, divided by that time under the plain step
    [[nodiscard]] std::string row() const { return name == default_choice ? for_the_devices : name; }
  };
  /// How a drive can move the switch to its contact through stable equilibria.
  struct StablePath {
    std::vector<std::string> drives;  ///< names of the drives; the drive that moves the switch to its contact comes first
    /// Share of the devices with a stable path to the contact within the limits of the voltage sources.
    double share = Metrics::unset;
    double reaches = Metrics::unset;  ///< voltage of the first drive at which the nominal design touches its contact [V]
    double limit = Metrics::unset;    ///< limit of the first drive's voltage towards the contact [V]
    /// Width of the range of positions in which 90 % of the devices touch: StableApproach::touch_places() [m].
    double touch_places = Metrics::unset;
    double rise = Metrics::unset;  ///< least time before the first device touches its contact under a slow waveform [s]
  };
  /// Contact gaps of devices over time, under the plain step and under the waveform of best.toml, at equal time steps.
  struct Courses {
    double end = Metrics::unset;              ///< last instant of the contact gaps over time [s]
    double unit = Metrics::unset;             ///< unit of the gaps in `step` and `own` [m]
    std::vector<std::vector<int>> step, own;  ///< contact gaps by device, then by instant [`unit`]
  };

  bool spread_assumed = false;
  std::string spread;  ///< the process variation in words
  double count = Metrics::unset, seed = Metrics::unset, closings = Metrics::unset;
  /// Minimised measure of risk and waveform family of the best waveform; empty if the plain step is best.
  std::string measure, waveform;
  bool better_than_plain_step = false;
  std::vector<std::string>
      worse_in;  ///< figures in which the best candidate waveform is worse than the plain step, if the plain step is best
  std::vector<Row> rows;
  /// Waveforms offered to the user, that with the earliest steady contact first; empty if the plain step is best.
  std::vector<Choice> choices;
  std::optional<StablePath> stable_path;
  /// True if the 95th percentile of the rebound height under the waveform of best.toml is not significant.
  std::optional<bool> goal_met;
  double missed_by = Metrics::unset;   ///< excess of the 95th percentile of the rebound height over the goal [m]; 0: goal met
  double step_delay = Metrics::unset;  ///< delay of the electrode's plain step, if its instant was searched [s]
  std::optional<Courses> courses;      ///< contact gaps of devices over time; none if the plain step is best
  std::vector<FrontPoint> front;       ///< performance of candidate waveforms, sorted by time of first contact
  /// Results by error of the measured Vdp, the least error first; none if Vdp is not measured.
  std::vector<CalibrationError> by_error;
  HoldWindows windows;          ///< hold voltages between which devices stay closed, by electrode
  std::vector<RaceEntry> race;  ///< candidates for the best waveform, the best first, on the devices on which it is chosen
  /// Conditions of the search on figures, and the share of devices that fulfil them under the best waveform.
  std::vector<FulfilledCondition> conditions;
  FigureValues drawing;  ///< figures of merit of the nominal design's waveform on the nominal device
  std::string drawing_status;
  bool drawing_goal_met = false;
  std::string measured;  ///< name of the row of results for the waveform in calibrated.toml; empty without this file
  std::string next_command;

  /// Returns the row of results with this name; null if no row has this name.
  [[nodiscard]] const Row* row(std::string_view name) const;
};

}  // namespace softland
