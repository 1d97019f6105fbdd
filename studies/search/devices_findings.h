// The findings of a search over varied devices, from which its reports are made: how the found waveforms perform on fresh
// devices (devices that the search has not used), and how they were chosen. The JSON of a search holds all findings
// (reports/search_json.cc), so that a report can be made again.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "objectives/figure_values.h"
#include "studies/devices/hold_window.h"
#include "studies/search/robust_optimize.h"

namespace softland {

class RobustSearch;         // robust_search.h
struct RobustSearchResult;  // robust_search_study.h

// Names of rows in the table of results. A row shows how one waveform performs on varied devices. The waveforms are the plain
// step, those searched for the nominal design and for varied devices, and the best one with the electrode's step at t = 0.
inline constexpr const char *plain_step_row = "plain step", *for_nominal_design = "for the drawing",
                            *for_the_devices = "for the devices", *undelayed_row = "electrode at t = 0";
/// Name of the choice whose waveform is in best.toml, among the waveforms offered to the user.
inline constexpr const char* default_choice = "default";

/// A point of the Pareto front of candidate waveforms in time of first contact and impact velocity, as evaluated on fresh
/// devices (new to the search).
struct FrontPoint {
  /// 95th percentiles of the first contact time [s] and of the impact velocity [m/s].
  double first_touch = Metrics::unset, impact_speed = Metrics::unset;
  double bounce_free = Metrics::unset;  ///< share of devices that close without a bounce
  std::string candidate;  ///< waveform family, and measure of risk that the search minimised: "bspline:6 by cvar:0.9"
};

/// Performance on fresh devices (new to the search) if the dynamic pull-in voltage Vdp of each device is measured with an
/// error. Each figure is the better of two: that under the waveforms searched with a per-device calibration, and that under the
/// best uncalibrated waveform.
struct CalibrationError {
  double error = 0;  ///< relative standard deviation of the error of the measured pull-in voltage
  /// Share of bounce-free devices; 95th percentile of the impact velocity [m/s].
  double bounce_free = Metrics::unset, impact_speed = Metrics::unset;
};

/// One of the candidate waveforms among which the search over devices chooses the best one, as shown in reports.
struct TournamentEntry {
  /// Measure of risk that the search minimised, and waveform family: "cvar:0.9", "knots:6". The measure is "drawing" for a
  /// candidate of the search on the nominal device.
  std::string measure, waveform;
  long closings = 0;
  /// Share of devices that close without a bounce, and cost, on the devices on which the best candidate is chosen.
  double bounce_free = 0, cost = 0;
};

/// Results of a search over varied devices: the found waveforms on fresh devices (new to the search), and how they were found.
struct DevicesFindings {
  /// A permitted rebound height, and its key in JSON: the yield is the share of devices whose rebounds stay below the height.
  struct YieldHeight {
    double height;  ///< permitted rebound height [m]
    const char* key;
  };
  static constexpr std::array yield_heights{YieldHeight{1e-9, "1e-9"}, YieldHeight{1e-8, "1e-8"}, YieldHeight{1e-7, "1e-7"}};

  struct Row {
    std::string name;  ///< name in the table of results: "plain step", "for the drawing" (nominal design), "Vdp to 1 %"
    /// Relative errors of the measured dynamic pull-in voltage and first natural frequency of each device; NaN: not measured.
    double pull_in_error = Metrics::unset, frequency_error = Metrics::unset;
    double piezo_error = Metrics::unset;  ///< relative error of the measured static deflection of each device by its piezo
    double time_error = Metrics::unset;   ///< standard deviation of the error of the measured closing time of each device [s]
    bool searched_for_it = true;
    /// Shares of the devices that are bounce-free, that stay open, and that collapse onto the electrode.
    double bounce_free = Metrics::unset, open = Metrics::unset, collapsed = Metrics::unset;
    /// 50th, 95th and 99th percentiles of figures, by key of device_figures; infinite if too many devices do not close.
    std::map<std::string, double> at_50, at_95, at_99;
    /// Shares of the devices whose highest rebound is below a permitted height, by the keys of yield_heights.
    std::map<std::string, double> yield;
  };
  /// A waveform that is offered to the user; row() returns the name of its row of results.
  struct Choice {
    std::string name, file, waveform;
    /// 95th percentile over the devices of the time until a steady contact force, as a multiple of that under the plain step.
    double tau = Metrics::unset;
    [[nodiscard]] std::string row() const { return name == default_choice ? for_the_devices : name; }
  };
  /// How a drive can move the switch to its contact through stable equilibria.
  struct StablePath {
    std::vector<std::string> drives;  ///< names of the drives; the drive that moves the switch to its contact comes first
    /// Share of the devices with a stable path to the contact within the limits of the voltage sources.
    double share = Metrics::unset;
    double reaches = Metrics::unset;  ///< voltage of the drive drives[0] at which the nominal design makes contact [V]
    double limit = Metrics::unset;    ///< voltage limit of the drive drives[0] in the direction of the contact [V]
    /// Width of the range of the contact point's positions at which the central 90 % of the devices make contact in a slow
    /// approach: StableApproach::touch_places() [m].
    double touch_places = Metrics::unset;
    /// Shortest time in which an input shaper brings the switch near its contact without vibration [s].
    double rise = Metrics::unset;
  };
  /// Contact gaps of devices over time, under the plain step and under the waveform of best.toml, at equal time steps.
  struct Courses {
    double end = Metrics::unset;              ///< last instant of the gaps in `step` and `own`; the first is t = 0 [s]
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
      /// If the plain step is best: figures of merit in which the best candidate waveform is worse than the plain step.
      worse_in;
  std::vector<Row> rows;
  /// Waveforms offered to the user, the waveform with the earliest steady contact first; empty if the plain step is best.
  std::vector<Choice> choices;
  std::optional<StablePath> stable_path;
  /// True if the 95th percentile of the rebound height under the waveform of best.toml is below a significant rebound.
  std::optional<bool> goal_met;
  /// Excess of the 95th percentile of the rebound height over a significant rebound [m]; 0: none.
  double missed_by = Metrics::unset;
  double step_delay = Metrics::unset;  ///< instant of the electrode's plain step, if the search chooses this instant [s]
  std::optional<Courses> courses;      ///< contact gaps of devices over time; none if the plain step is best
  std::vector<FrontPoint> front;       ///< the Pareto front of candidate waveforms, sorted by time of first contact
  /// Performance by error of the measured dynamic pull-in voltage, the least error first; empty if devices are not calibrated.
  std::vector<CalibrationError> by_error;
  HoldWindows windows;  ///< range of the hold voltage in which devices stay closed, by electrode
  /// Candidates for the best waveform, the best first, with their results on the devices that serve to compare candidates.
  std::vector<TournamentEntry> tournament;
  /// Conditions of the search on figures, and the share of devices that fulfil them under the best waveform.
  std::vector<FulfilledCondition> conditions;
  FigureValues nominal;  ///< figures of merit of the closing of the nominal device under its own best waveform
  std::string nominal_status;
  bool nominal_goal_met = false;
  std::string measured;  ///< name in the table of results of the waveform in calibrated.toml; empty without this file
  std::string next_command;

  /// Returns the row of results with this name; null if no row has this name.
  [[nodiscard]] const Row* row(std::string_view name) const;
};

/// Finds the Pareto front of the candidate waveforms in time of first contact and impact velocity, and evaluates its candidates
/// on the fresh devices (new to the search).
void judge_front(RobustSearchResult& result, RobustSearch& search, const Progress& progress);
/// Computes the contact gaps of some devices over time, under the plain step and the best waveform, until the contact force is
/// steady.
void draw_courses(RobustSearchResult& result, const RobustnessOptions& judging, const Progress& progress);
/// Copies the results of the search to the findings, except those that were added during the final evaluation.
void complete_findings(RobustSearchResult& result, RobustSearch& search, std::uint64_t seed);

}  // namespace softland
