// The findings of a search for devices, from which its reports are made: how its waveforms do on fresh devices, and what led to
// them. The JSON of a search holds them whole (reports/closing_members.h), so that a report can be made again.
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

// Names of rows.
inline constexpr const char *plain_step_row = "plain step", *for_the_drawing = "for the drawing",
                            *for_the_devices = "for the devices", *undelayed_row = "electrode at t = 0";
inline constexpr const char* default_choice = "default";  ///< name of the waveform that best.toml holds

/// A candidate on the fresh devices.
struct FrontPoint {
  double first_touch = Metrics::unset, impact_speed = Metrics::unset;  ///< 95th percentiles [s], [m/s]
  double bounce_free = Metrics::unset;                                 ///< share of the devices
  std::string candidate;                                               ///< "bspline:6 by cvar:0.9"
};

/// Results where Vdp of each device is known with an error, on the first of the fresh devices. Each figure is that of the best
/// waveform: of those that were searched with a per-device calibration, and of the winner in volts.
struct CalibrationError {
  double error = 0;                                                    ///< standard deviation of the error of Vdp, relative
  double bounce_free = Metrics::unset, impact_speed = Metrics::unset;  ///< share of the devices; 95th percentile [m/s]
};

/// A candidate of the choice.
struct RaceEntry {
  std::string measure, waveform;  ///< "cvar:0.9", "knots:6"; measure "drawing" for what the nominal search tried
  long closings = 0;
  double bounce_free = 0, cost = 0;  ///< on the devices of the choice: share of the devices; cost
};

/// Figures of the waveforms of a search for devices, on fresh devices.
struct DevicesFindings {
  /// Rebound heights below which a device counts for a yield, and their names in JSON.
  struct YieldHeight {
    double height;  ///< [m]
    const char* key;
  };
  static constexpr std::array yield_heights{YieldHeight{1e-9, "1e-9"}, YieldHeight{1e-8, "1e-8"}, YieldHeight{1e-7, "1e-7"}};

  struct Row {
    std::string name;                                                         ///< "plain step", "for the drawing", "Vdp to 1 %"
    double pull_in_error = Metrics::unset, frequency_error = Metrics::unset;  ///< relative errors; NaN: not measured
    double piezo_error = Metrics::unset;                                      ///< relative error of the piezo's unit
    double time_error = Metrics::unset;                                       ///< error of a closing time [s]
    bool searched_for_it = true;
    double bounce_free = Metrics::unset, open = Metrics::unset, collapsed = Metrics::unset;  ///< shares of the devices
    /// 50th, 95th and 99th percentiles, by key of device_figures; infinite if more devices do not close.
    std::map<std::string, double> at_50, at_95, at_99;
    std::map<std::string, double> yield;  ///< shares of the devices whose rebound is within yield_heights
  };
  /// A waveform that may be chosen; its row has the same name, and "for the devices" for the default.
  struct Choice {
    std::string name, file, waveform;
    double tau = Metrics::unset;  ///< time until a steady contact, over that of the plain step
    [[nodiscard]] std::string row() const { return name == default_choice ? for_the_devices : name; }
  };
  /// How the switch can be carried to its contact through stable equilibria.
  struct StablePath {
    std::vector<std::string> drives;       ///< drives, first the one that carries the switch
    double share = Metrics::unset;         ///< share of the devices with such a path within the limits
    double reaches = Metrics::unset;       ///< voltage at which the nominal design touches [V]
    double limit = Metrics::unset;         ///< limit of the driver on that side [V]
    double touch_places = Metrics::unset;  ///< range in which 90 % of the devices touch: StableApproach::touch_places() [m]
    double rise = Metrics::unset;          ///< least time before the first of them touches [s]
  };
  /// Gaps of devices under the plain step and under best.toml, at instants that divide the time evenly.
  struct Courses {
    double end = Metrics::unset;              ///< the last instant [s]
    double unit = Metrics::unset;             ///< unit of the gaps [m]
    std::vector<std::vector<int>> step, own;  ///< gaps by device, then by instant
  };

  bool spread_assumed = false;
  std::string spread;  ///< the spread in words
  double count = Metrics::unset, seed = Metrics::unset, closings = Metrics::unset;
  std::string measure, waveform;  ///< measure and family of the winner; empty if the plain step wins
  bool better_than_plain_step = false;
  std::vector<std::string> worse_in;  ///< figures in which the best candidate is worse, where the plain step wins
  std::vector<Row> rows;
  std::vector<Choice> choices;  ///< choices, the soonest first; empty if the plain step wins
  std::optional<StablePath> stable_path;
  std::optional<bool> goal_met;                ///< true if the 95th percentile of the rebounds of best.toml is not significant
  double missed_by = Metrics::unset;           ///< excess of that percentile; 0 if the goal is met [m]
  double step_delay = Metrics::unset;          ///< delay of the electrode's plain step, where its instant was searched [s]
  std::optional<Courses> courses;              ///< none if the plain step wins
  std::vector<FrontPoint> front;               ///< candidates, sorted by first touch
  std::vector<CalibrationError> by_error;      ///< results with the least error first; none if Vdp is not measured
  HoldWindows windows;                         ///< windows of hold levels
  std::vector<RaceEntry> race;                 ///< candidates of the choice, the best first
  std::vector<FulfilledCondition> conditions;  ///< conditions, and how the winner fulfils them
  FigureValues drawing;                        ///< figures of the nominal design's waveform on the nominal device
  std::string drawing_status;
  bool drawing_goal_met = false;
  std::string measured;  ///< name of the row of calibrated.toml; empty if there is no such file
  std::string next_command;

  /// Returns null if no row has that name.
  [[nodiscard]] const Row* row(std::string_view name) const;
};

}  // namespace softland
