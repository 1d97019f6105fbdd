// What a study found, as the typed value that every output is made from, JSON too. It has two makers: result_of() for the values
// of a study, and read_result() for the result.json of an earlier one. What is not available is NaN, empty or not set.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/scene.h"
#include "model/closing.h"
#include "objectives/figures.h"
#include "studies/closing/certify.h"
#include "studies/closing/closed_state.h"
#include "studies/devices/hold_window.h"
#include "studies/stored_search/seed_study.h"

namespace softland {

/// Points [x, y] in order.
using Points = std::vector<std::array<double, 2>>;

/// The motion of a run at the contact point. A column that is not as long as `time` is damaged, or missing.
struct ResultCurve {
  std::vector<double> time;      ///< [s]
  std::vector<double> gap;       ///< distance to the contact plane [m]
  std::vector<double> velocity;  ///< towards the contact [m/s]
  std::vector<double> force;     ///< of the contact on the beam [N]
  /// Of the connection, NaN while it is open [Ohm]; empty where the contacts have no resistivity.
  std::vector<double> resistance = {};
  std::vector<Rebound> rebounds;
};

/// The winner or the single run, or the baseline.
struct ResultRun {
  std::string status;
  std::optional<FigureValues> figures;  ///< none: the run is not there
  FigureValues errors;
  ResultCurve curve;
  std::map<std::string, Points> waveforms;  ///< by drive: time [s] and level [V], of the dispersion force its factor
  double cost = Metrics::unset;
  double collapse_time = Metrics::unset;  ///< at which the beam met the electrode [s]
};

/// Another run of the winner.
struct ResultCheck {
  std::string name, status;
  std::optional<FigureValues> figures;
  /// Under another gas law: what differs is what is simulated, not how.
  [[nodiscard]] bool is_of_gas() const { return name.starts_with("gas "); }
};

struct ResultSearch {
  std::string value_name;  ///< what the search minimises
  Points best_so_far;      ///< index of an evaluation, value
  Points evaluations;      ///< the same of all; a value is NaN where it was infeasible
};

/// What the source of a drive can do; NaN where the scene sets no limit.
struct DriveLimits {
  double lowest = Metrics::unset, highest = Metrics::unset;  ///< [V]
  double slew = Metrics::unset;                              ///< [V/s]
};

/// Rows of a curve, rebounds, and evaluations of a search that a result holds at most: its file stays readable (base/read_file.h)
/// however long a run is.
inline constexpr std::size_t most_curve_rows = 20'000, most_rebounds = 20'000, most_evaluations = 100'000;

/// What a report shows of the scene.
struct ResultScene {
  using Span = std::optional<std::array<double, 2>>;  ///< from the clamped end [m]
  struct Piezo {
    Span span;
  };
  struct Electrode {
    std::string name;
    Span span;
    bool far_side = false;
    double gap = Metrics::unset;  ///< [m]
  };
  struct Waveform {
    std::string family;
    std::vector<double> times;                                                   ///< [s]
    double edge = Metrics::unset, start = Metrics::unset, end = Metrics::unset;  ///< [s]
  };

  std::string structure;                                                ///< "cantilever"; empty: not known
  double length = Metrics::unset;                                       ///< [m]
  double electrode_gap = Metrics::unset, contact_gap = Metrics::unset;  ///< [m]
  double pad_length = Metrics::unset;                                   ///< [m]
  std::optional<Piezo> piezo;
  std::vector<Electrode> electrodes;
  std::map<std::string, Waveform> waveforms;  ///< by drive
  std::map<std::string, DriveLimits> drivers;
  double significant_rebound = MetricsOptions{}.significant_rebound;  ///< [m]
  std::string text;                                                   ///< the file
  nlohmann::json tree;                                                ///< the same as its sections, quantities as text
};

/// What can change the last digits of a result: see made_with().
struct MadeWith {
  std::string program, compiler, options, instruction_set, vectors, c_library, processor;
};

/// What effects = "auto" left out.
struct ResultEffects {
  struct LeftOut {
    std::string effect;
    double influence = Metrics::unset;
  };
  std::vector<LeftOut> left_out;
  double influence = Metrics::unset;  ///< of all together
};

/// Of a search over devices that differ.
struct ResultRobust {
  struct Condition {
    std::string text;
    double share = Metrics::unset, low = Metrics::unset, high = Metrics::unset;  ///< of devices that fulfil it, 95 % confidence
    bool holds = false;
  };
  std::string measure;
  double devices = Metrics::unset, fresh_devices = Metrics::unset, closings = Metrics::unset;
  double cost_on_searched = Metrics::unset;  ///< of the winner, on the devices that were searched
  double failing = Metrics::unset;  ///< share of the fresh devices that end open, are not kept closed, or are outside the model
  bool is_told = true;              ///< the measure looks further than at those
  std::optional<Condition> yield;   ///< what was to be fulfilled by as many devices as possible
  std::vector<Condition> conditions;
};

/// Of a search for devices, what its waveforms do on fresh ones.
struct ResultDevices {
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
    /// Quantiles, as those of its row.
    std::map<std::string, double> at_95 = {}, at_99 = {};
    [[nodiscard]] std::string row() const { return name == "default" ? "for the devices" : name; }
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
  struct FrontPoint {
    double first_touch = Metrics::unset, impact_speed = Metrics::unset, bounce_free = Metrics::unset;
    std::string candidate;  ///< "bspline:6 by cvar:0.9"
  };
  /// What a measured Vdp is worth, by its error: see KnownVdp.
  struct ByError {
    double error = Metrics::unset, bounce_free = Metrics::unset, impact_speed = Metrics::unset;
  };
  struct Racer {
    std::string measure, waveform;
    double closings = Metrics::unset, cost = Metrics::unset, bounce_free = Metrics::unset;
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
  std::optional<bool> goal_met;        ///< 95 % of the devices of best.toml rebound by no more than counts
  double missed_by = Metrics::unset;   ///< by which their rebound is more; 0 where the goal is met [m]
  double step_delay = Metrics::unset;  ///< of the electrode's plain step, where its instant was searched [s]
  std::optional<Courses> courses;      ///< none where the plain step wins
  std::vector<FrontPoint> front;
  std::vector<ByError> by_error;
  HoldWindows windows;  ///< of hold levels
  std::vector<Racer> race;
  std::vector<ResultRobust::Condition> conditions;
  FigureValues drawing;  ///< of the drawing's waveform on the nominal device
  std::string drawing_status;
  bool drawing_goal_met = false;
  std::string measured;  ///< the row that calibrated.toml is of; empty where there is none
  std::string next_command;

  /// Null where there is none of that name.
  [[nodiscard]] const Row* row(std::string_view name) const;
};

/// The least time in which any waveform of the same drives and limits touches no faster than the winner.
struct ResultLimit {
  double least_time = Metrics::unset, impact_velocity = Metrics::unset;  ///< [s], [m/s]
};

/// Searches that differ in their seeds alone; the result is that of the best.
struct ResultSeeds {
  std::uint64_t planned = 0;           ///< searches, of which those below are done
  std::vector<SearchOfSeed> searches;  ///< in the order of their seeds
  std::size_t best = 0;                ///< of them
};

/// What the search within one of several families came to.
struct ResultFamily {
  std::string family;
  double evaluations = Metrics::unset, cost = Metrics::unset;
};

struct ResultPullIn {
  double static_pull_in = Metrics::unset, dynamic_pull_in = Metrics::unset;  ///< [V]
  std::optional<ByModes> static_by_modes = {};  ///< none where there are no more modes than the scene has
};

struct Result {
  bool is_search = false;  ///< of optimize, else of simulate
  std::string status, message, title;
  std::string target, actuator, waveform, optimizer, termination, termination_message;  ///< of a search
  std::vector<ResultFamily> families;  ///< of the search, where there were several
  std::optional<std::uint64_t> seed;
  std::optional<bool> goal_met, better_than_baseline, plain_step_wins;
  double harder_than_step = Metrics::unset;  ///< see OptimizeResult
  double evaluations = Metrics::unset;
  ResultRun best;      ///< the winner, or the single run
  ResultRun baseline;  ///< the plain step
  std::optional<Certificate> certificate;
  std::optional<ClosedState> closed_state;  ///< under the hold levels; none without a contact
  std::vector<ResultCheck> checks;
  double evaluations_of_modes = Metrics::unset;  ///< see OptimizeResult
  ResultSearch search;
  std::optional<ResultRobust> robust;
  std::optional<ResultDevices> devices;
  std::optional<ResultSeeds> seeds;
  std::optional<ResultLimit> limit;
  std::map<std::string, double> parameters;             ///< of the winner, by drive.name
  std::map<std::string, std::array<double, 2>> bounds;  ///< within which they were searched
  std::map<std::string, ResultPullIn> pull_in;          ///< by electrode
  std::vector<double> natural_frequencies;              ///< [rad/s]
  std::optional<Work> work;                             ///< of the shown run
  std::vector<std::string> warnings;
  ResultScene scene;
  std::optional<ResultEffects> effects;
  double tolerance = Metrics::unset;  ///< of the integrator, in the shown run
  std::string command, version;
  std::vector<std::string> reproduce;  ///< command lines
  MadeWith made_with;
};

}  // namespace softland
