// What a study found, as the typed value that every output is made from, JSON too. It has two makers: result_of() for the values
// of a study, and read_result() for the result.json of an earlier one. What is not available is NaN, empty or not set.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/scene.h"
#include "model/closing.h"
#include "objectives/figures.h"
#include "reports/origin.h"
#include "studies/closing/certify.h"
#include "studies/closing/closed_state.h"
#include "studies/search/devices_findings.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_optimize.h"
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

/// One of several contacts in the winner or the single run.
struct ResultContact {
  double gap = Metrics::unset;  ///< rest distance of its place to its plane [m]
  FigureValues figures;
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
  struct Contact {
    std::string name;
    double at = Metrics::unset;   ///< from the clamped end [m]; NaN: at the tip, or in the middle
    double gap = Metrics::unset;  ///< [m]
    bool far_side = false;
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
  std::vector<Contact> contacts;              ///< where they have names
  std::map<std::string, Waveform> waveforms;  ///< by drive
  std::map<std::string, DriveLimits> drivers;
  double significant_rebound = MetricsOptions{}.significant_rebound;  ///< [m]
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

struct ResultPullIn {
  double static_pull_in = Metrics::unset, dynamic_pull_in = Metrics::unset;  ///< [V]
  std::optional<ByModes> static_by_modes = {};  ///< none where there are no more modes than the scene has
};

struct Result {
  Origin origin;  ///< its kind is "simulate" or "optimize"
  std::string status, message, title;
  std::string target, actuator, waveform, optimizer, termination, termination_message;  ///< of a search
  std::vector<SearchedFamilyResult> families;  ///< of the search, where there were several
  std::optional<std::uint64_t> seed;
  std::optional<bool> goal_met, better_than_baseline, plain_step_wins;
  double harder_than_step = Metrics::unset;  ///< see OptimizeResult
  double evaluations = Metrics::unset;
  ResultRun best;                                 ///< the winner, or the single run
  ResultRun baseline;                             ///< the plain step
  std::map<std::string, ResultContact> contacts;  ///< by name, where there are several: the other figures are of the connection
  std::optional<Certificate> certificate;
  std::optional<ClosedState> closed_state;  ///< under the hold levels; none without a contact
  std::vector<ResultCheck> checks;
  double evaluations_of_modes = Metrics::unset;  ///< see OptimizeResult
  ResultSearch search;
  std::optional<RobustFindings> robust;
  std::optional<DevicesFindings> devices;
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
  double tolerance = Metrics::unset;   ///< of the integrator, in the shown run
  std::vector<std::string> reproduce;  ///< command lines

  [[nodiscard]] bool is_search() const { return origin.kind == "optimize"; }
};

}  // namespace softland
