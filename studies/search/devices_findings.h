// What a search for devices came to, as its reports are made from it: what its waveforms do on fresh devices, and what led to
// them. The JSON of a search holds it whole (reports/closing_members.h), so that a report can be made again.
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
inline constexpr const char* default_choice = "default";  ///< what best.toml holds

/// A candidate on the fresh devices.
struct FrontPoint {
  double first_touch = Metrics::unset, impact_speed = Metrics::unset;  ///< 95 % quantiles [s], [m/s]
  double bounce_free = Metrics::unset;                                 ///< share of the devices
  std::string candidate;                                               ///< "bspline:6 by cvar:0.9"
};

/// What is reached in units of a Vdp that is measured with an error, on the first of the fresh devices, each figure by the best
/// of the waveforms that were searched in measured units, and of the winner in volts.
struct KnownVdp {
  double error = 0;                                                    ///< of Vdp, standard deviation, relative
  double bounce_free = Metrics::unset, impact_speed = Metrics::unset;  ///< share of the devices; 95 % quantile [m/s]
};

/// A candidate of the choice.
struct RaceEntry {
  std::string measure, waveform;  ///< "cvar:0.9", "knots:6"; measure "drawing" for what the nominal search tried
  long closings = 0;
  double bounce_free = 0, cost = 0;  ///< on the devices of the choice: share of the devices; cost
};

/// Of a search for devices, what its waveforms do on fresh ones.
struct DevicesFindings {
  /// Rebounds below which a device counts for a yield, and as JSON names them.
  struct YieldHeight {
    double height;  ///< [m]
    const char* key;
  };
  static constexpr std::array yield_heights{YieldHeight{1e-9, "1e-9"}, YieldHeight{1e-8, "1e-8"}, YieldHeight{1e-7, "1e-7"}};

  struct Row {
    std::string name;                                                         ///< "plain step", "for the drawing", "Vdp to 1 %"
    double pull_in_error = Metrics::unset, frequency_error = Metrics::unset;  ///< of what is measured, relative; NaN: it is not
    double piezo_error = Metrics::unset;                                      ///< of its piezo's unit, relative
    double time_error = Metrics::unset;                                       ///< of a closing time [s]
    bool searched_for_it = true;
    double bounce_free = Metrics::unset, open = Metrics::unset, collapsed = Metrics::unset;  ///< shares of the devices
    /// Quantiles at 50, 95 and 99 %, by key of device_figures; infinite where more do not close.
    std::map<std::string, double> at_50, at_95, at_99;
    std::map<std::string, double> yield;  ///< shares of devices by how far they rebound at most: yield_heights
  };
  /// A waveform that may be chosen: its row is that of its name, or for the default "for the devices".
  struct Choice {
    std::string name, file, waveform;
    double tau = Metrics::unset;  ///< what its devices wait for a steady contact, over the plain step
    [[nodiscard]] std::string row() const { return name == default_choice ? for_the_devices : name; }
  };
  /// How the switch can be carried to its contact through stable equilibria.
  struct StablePath {
    std::vector<std::string> drives;       ///< the one that carries it first
    double share = Metrics::unset;         ///< of the devices that have such a path within the limits
    double reaches = Metrics::unset;       ///< at which the nominal design touches [V]
    double limit = Metrics::unset;         ///< of the driver, on that side [V]
    double touch_places = Metrics::unset;  ///< within which 90 % of the devices touch: StableApproach::touch_places() [m]
    double rise = Metrics::unset;          ///< the least time that passes before the first of them [s]
  };
  /// Gaps of devices under the plain step and under best.toml, at instants that divide the time evenly.
  struct Courses {
    double end = Metrics::unset;              ///< the last instant [s]
    double unit = Metrics::unset;             ///< of the gaps [m]
    std::vector<std::vector<int>> step, own;  ///< by device, then by instant
  };

  bool spread_assumed = false;
  std::string spread;  ///< in words
  double count = Metrics::unset, seed = Metrics::unset, closings = Metrics::unset;
  std::string measure, waveform;  ///< of the winner; empty where the plain step wins
  bool better_than_plain_step = false;
  std::vector<std::string> worse_in;  ///< figures of the best candidate, where the plain step wins
  std::vector<Row> rows;
  std::vector<Choice> choices;  ///< the soonest first; empty where the plain step wins
  std::optional<StablePath> stable_path;
  std::optional<bool> goal_met;                ///< 95 % of the devices of best.toml rebound by no more than counts
  double missed_by = Metrics::unset;           ///< by which their rebound is more; 0 where the goal is met [m]
  double step_delay = Metrics::unset;          ///< of the electrode's plain step, where its instant was searched [s]
  std::optional<Courses> courses;              ///< none where the plain step wins
  std::vector<FrontPoint> front;               ///< by first touch
  std::vector<KnownVdp> by_error;              ///< the least error first; none where Vdp is not measured
  HoldWindows windows;                         ///< of hold levels
  std::vector<RaceEntry> race;                 ///< the best first
  std::vector<FulfilledCondition> conditions;  ///< of the winner
  FigureValues drawing;                        ///< of the drawing's waveform on the nominal device
  std::string drawing_status;
  bool drawing_goal_met = false;
  std::string measured;  ///< the row that calibrated.toml is of; empty where there is none
  std::string next_command;

  /// Null where there is none of that name.
  [[nodiscard]] const Row* row(std::string_view name) const;
};

}  // namespace softland
