// A ClosingRecord holds the results of `simulate`, or of a search by `optimize` with the closing that it found. Every output,
// also JSON, is made from it. record_of() makes the record; read_closing() reads it from JSON. A member that is not available
// is NaN, empty or not set.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/chart.h"
#include "model/closing.h"
#include "objectives/figure_values.h"
#include "objectives/metrics.h"
#include "reports/origin.h"
#include "studies/closing/certify.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/shown_motion.h"
#include "studies/closing/simulate.h"
#include "studies/search/devices_findings.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_optimize.h"
#include "studies/search/robust_search_study.h"
#include "studies/search/seed_study.h"

namespace softland {

/// The limits of the voltage source of an electrode or a piezo; a limit that the scene does not set is NaN.
struct DriveLimits {
  double lowest = Metrics::unset, highest = Metrics::unset;  ///< lowest and highest voltage that the source permits [V]
  double slew = Metrics::unset;                              ///< largest slew rate that the source permits [V/s]
};

/// A kind of structure for a drawing from the side.
enum class SideOfStructure {
  unknown,            ///< a structure of unknown shape
  held_at_one_end,    ///< a beam clamped at one end
  held_at_both_ends,  ///< a beam clamped at both ends
  on_springs,         ///< a rigid plate on springs
};
/// Returns the kind of a structure with this name in scenes.
[[nodiscard]] SideOfStructure side_of_structure(std::string_view kind);

/// The parts of a scene that reports show.
struct DrawnScene {
  /// Begin and end of a part of the beam: distances from the clamped end [m].
  using Span = std::optional<std::array<double, 2>>;
  struct Piezo {
    Span span;
  };
  struct Electrode {
    std::string name;
    Span span;
    bool far_side = false;
    double gap = Metrics::unset;  ///< rest gap of the electrode [m]
  };
  struct Contact {
    std::string name;
    /// Distance of the contact from the clamped end [m]; NaN: tip, or middle of a plate or of a beam with two clamps.
    double at = Metrics::unset;
    double gap = Metrics::unset;  ///< rest gap of the contact [m]
    bool far_side = false;
  };
  struct Waveform {
    std::string family;
    std::vector<double> times;  ///< switching times of the waveform family `pulse` [s]
    /// Duration of an edge (ramp) of the waveform; start and end of the waveform [s].
    double edge = Metrics::unset, start = Metrics::unset, end = Metrics::unset;
  };

  SideOfStructure structure = SideOfStructure::unknown;
  double length = Metrics::unset;  ///< length of the structure [m]
  /// Rest gap of the electrode and rest gap of the contact [m].
  double electrode_gap = Metrics::unset, contact_gap = Metrics::unset;
  double pad_length = Metrics::unset;  ///< length of the contact pad [m]
  std::optional<Piezo> piezo;
  std::vector<Electrode> electrodes;
  std::vector<Contact> contacts;              ///< contacts that have names
  std::map<std::string, Waveform> waveforms;  ///< waveforms by name of the electrode, piezo or dispersion force
  std::map<std::string, DriveLimits> drivers;
  double significant_rebound = MetricsOptions{}.significant_rebound;  ///< least height of a significant rebound [m]
};

/// Reads the JSON of a resolved scene. Every part is optional: a part that is missing, null or of another type is not
/// available.
[[nodiscard]] DrawnScene read_drawn_scene(const nlohmann::json& scene);

/// A time span in which a contact is closed in a simulated run.
struct ClosedStretch {
  double begin = 0;  ///< time at which the contact closes [s]
  /// Time at which the contact opens [s]; NaN: still closed at the end of the simulated time.
  double end = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t touches = 1;  ///< number of touches in the span; openings between several touches are not recorded
};

/// The motion of a run at the contact point. A column whose length differs from that of `time` is damaged or missing.
struct CurveRecord {
  std::vector<double> time;      ///< times since the start of the run [s]
  std::vector<double> gap;       ///< distance of the contact point to the contact plane [m]
  std::vector<double> velocity;  ///< velocity of the contact point towards the contact [m/s]
  std::vector<double> force;     ///< contact force on the beam [N]
  /// Resistance of the closed switch between its terminals [Ohm]; NaN while it is open; empty if no contact has a resistivity.
  std::vector<double> resistance = {};
  std::vector<Rebound> rebounds;
  /// Times in which the contact is closed; of several contacts, times in which their electrical connection is closed.
  std::optional<std::vector<ClosedStretch>> closed = {};
  std::map<std::string, std::vector<ClosedStretch>> closed_contacts = {};  ///< times in which each contact is closed, by name
  std::optional<ShownMotion> motion = {};  ///< motion of the whole structure; none if the run stopped early
};

/// The run under the best waveform of a search, the run under the plain step, or the run of a single simulation.
struct RunRecord {
  std::string status;
  std::optional<FigureValues> figures;  ///< figures of merit of the run; none if there was no such run
  FigureValues errors;
  CurveRecord curve;
  /// Waveforms by electrode or piezo: time [s] and level [V]; for the dispersion force, its factor.
  std::map<std::string, Points> waveforms;
  double cost = Metrics::unset;
  double collapse_time = Metrics::unset;  ///< time at which the beam touched the electrode [s]
};

/// Figures of merit of one of several contacts, in the run with the best waveform or in the single run.
struct ContactFigures {
  double gap = Metrics::unset;  ///< rest distance from the contact's position to its contact plane [m]
  FigureValues figures;
};

/// Limits of the numbers of curve rows, rebounds, evaluations of a search and closed time spans in a result, so that the file
/// of a run of any length can be read (base/read_file.h).
inline constexpr std::size_t most_curve_rows = 20'000, most_rebounds = 20'000, most_evaluations = 100'000,
                             most_closed_stretches = 1000;

/// A repeated simulation of the best waveform with other settings, which confirms its figures of merit.
struct ConfirmationRecord {
  std::string name, status;
  std::optional<FigureValues> figures;
  /// Returns true if the repeated simulation has another gas law: it then differs in physics, not in the numerical method.
  [[nodiscard]] bool is_of_gas() const { return name.starts_with("gas "); }
};

struct SearchCourse {
  std::string value_name;  ///< name of the value that the search minimises
  Points best_so_far;      ///< points (index of an evaluation, least minimised value up to this evaluation)
  Points evaluations;      ///< points (index, minimised value) of every evaluation; the value is NaN for an infeasible waveform
};

/// The least closing time of any waveform on the same electrodes and piezos, within the same voltage limits, with at most the
/// impact velocity of the best waveform.
struct TouchLimit {
  /// Least closing time [s], permitted impact velocity [m/s].
  double least_time = Metrics::unset, impact_velocity = Metrics::unset;
};

/// Searches that differ only in their seeds; the result is that of the best search.
struct SeedsFindings {
  std::uint64_t planned = 0;           ///< planned number of searches, one per seed
  std::vector<SearchOfSeed> searches;  ///< results of the completed searches, ascending by seed
  std::size_t best = 0;                ///< index in `searches` of the best search
};

/// The results of a search, a part of the results of the closing that the search found. A member that is not available is NaN,
/// empty or not set.
struct SearchRecord {
  std::string target, actuator, waveform, optimizer, termination, termination_message;
  std::vector<SearchedFamilyResult> families;  ///< results by waveform family; empty unless several families were searched
  std::optional<std::uint64_t> seed;
  std::optional<bool> goal_met, better_than_baseline, plain_step_wins;
  /// Largest relative excess of the best waveform over the plain step in impact velocity, peak contact force or impact energy;
  /// 0: none.
  double harder_than_step = Metrics::unset;
  double evaluations = Metrics::unset;
  RunRecord baseline;                                   ///< run under the plain step, with which the search compares
  std::map<std::string, double> parameters;             ///< parameters of the best waveform, by names such as "main.level_1_V"
  std::map<std::string, std::array<double, 2>> bounds;  ///< lower and upper bound between which each parameter was searched
  std::vector<ConfirmationRecord> checks;
  double evaluations_of_modes = Metrics::unset;  ///< number of further evaluations, each with several numbers of modes
  SearchCourse course;
  std::optional<RobustFindings> robust;
  std::optional<DevicesFindings> devices;
  std::optional<SeedsFindings> seeds;
  std::optional<TouchLimit> limit;
  std::vector<std::string> reproduce;  ///< command lines that reproduce the result of the search
};

/// The effects that the setting effects = "auto" left out of the model.
struct EffectsLeftOut {
  struct LeftOut {
    std::string effect;
    double influence = Metrics::unset;
  };
  std::vector<LeftOut> left_out;
  double influence = Metrics::unset;  ///< estimated relative influence of all omitted effects together on the figures of merit
};

struct PullInOfElectrode {
  /// Static and dynamic pull-in voltage of one electrode [V].
  double static_pull_in = Metrics::unset, dynamic_pull_in = Metrics::unset;
  /// Static pull-in voltage by number of modes; none if no modes could be added to those of the scene.
  std::optional<ByModes> static_by_modes = {};
};

struct ClosingRecord {
  Origin origin;  ///< verb, program, machine, command line and scene of the result; its kind is "simulate" or "optimize"
  std::string status, message, title;
  RunRecord best;  ///< the single run, or the run under the best waveform of a search
  /// Figures of merit by contact, if there are several; `best` has the figures of the electrical connection they make.
  std::map<std::string, ContactFigures> contacts;
  std::optional<Certificate> certificate;
  std::optional<ClosedState> closed_state;  ///< state of the closed switch under the hold voltages; none without a contact
  std::map<std::string, PullInOfElectrode> pull_in;  ///< pull-in voltages by actuating electrode
  std::vector<double> natural_frequencies;           ///< natural angular frequencies of the structure [rad/s]
  std::optional<Work> work;                          ///< numerical work (steps, evaluations) of the run in `best`
  std::vector<std::string> warnings;
  DrawnScene scene;
  std::optional<EffectsLeftOut> effects;
  double tolerance = Metrics::unset;   ///< relative tolerance of the integrator in the run in `best`
  std::optional<SearchRecord> search;  ///< the search that found the run in `best`; none for a single run

  /// Returns the run under the plain voltage step that a search compares with; an empty run if there was no search.
  [[nodiscard]] const RunRecord& baseline() const;
  /// Returns the findings of a search about devices under process variation; null if there are none.
  [[nodiscard]] const DevicesFindings* devices() const { return search && search->devices ? &*search->devices : nullptr; }
};

/// Returns the motion of a run at the contact point: the end points of the integrator's steps, and interpolated points within
/// long steps. Of a long run, at most most_curve_rows points stay, which draw the same picture with all extremes, and the
/// most_rebounds highest rebounds.
[[nodiscard]] CurveRecord curve_of(const Trajectory& trajectory, const MetricsOptions& options);
/// Returns the motion of a run at the contact point, with `rebounds` that were found during the run. If `is_thinned`, the
/// trajectory keeps only some of the integrator's steps, and no points are interpolated between them.
[[nodiscard]] CurveRecord curve_of(const Trajectory& trajectory, const std::vector<Rebound>& rebounds, bool is_thinned,
                                   const MetricsOptions& options);

/// Returns the touches of a run as times in which the contact is closed. More than `most` touches are joined across the
/// shortest openings.
[[nodiscard]] std::vector<ClosedStretch> closed_stretches(const std::vector<Touch>& touches,
                                                          std::size_t most = most_closed_stretches);

/// Returns the evaluations of a search; of a long search, the most_evaluations that draw the same picture.
[[nodiscard]] Points drawn_evaluations(Points all);

/// Makes the results of `simulate`; `command` is the command line. Curves have the resolution of the integration, up to
/// most_curve_rows. With `shows_motion` the closing is simulated once more for the animation of the page.
[[nodiscard]] ClosingRecord record_of(const PreparedScene& prepared, const Closing& closing, const std::string& command,
                                      bool shows_motion = true);

/// Makes the results of `optimize`. Equal seeds give equal results, apart from the elapsed time and the command line. The
/// results have only the evaluations that improved the best cost.
[[nodiscard]] ClosingRecord record_of(const OptimizeResult& found, const OptimizeOptions& options, const std::string& command);

/// Makes the results of a search that minimises one statistic of the devices under process variation.
[[nodiscard]] ClosingRecord record_of(const RobustResult& found, const OptimizeOptions& options, const std::string& command);

/// Makes the results of a search that offers several waveforms for the devices under process variation, with the best of them.
[[nodiscard]] ClosingRecord record_of(const RobustSearchResult& found, const OptimizeOptions& options, std::string next_command,
                                      const std::string& command);

/// Names the members of the JSON.
void members(internal::Archive& a, ClosingRecord& record);
void members(internal::Archive& a, RunRecord& run);
void members(internal::Archive& a, CurveRecord& curve);
void members(internal::Archive& a, ConfirmationRecord& check);
/// Names the members of the JSON of a search, which are at the same level as those of the closing that the search found.
void members_of_search(internal::Archive& a, SearchRecord& search, ClosingRecord& closing);
/// Returns the results of a closing as JSON for programs: SI units in the names, non-finite numbers as null.
[[nodiscard]] nlohmann::json json_of(const ClosingRecord& record);
/// Returns the results of a closing as --json writes them: without large parts (curves, the text of the scene, the log of the
/// search) and without repetitions.
[[nodiscard]] nlohmann::json summary_json(nlohmann::json record);
/// Returns status and figures of merit of a run as JSON, except figures of the drive waveforms themselves, such as the peak
/// voltage.
[[nodiscard]] nlohmann::json metrics_json(const Metrics& metrics);

/// Parses the content of a result.json: an object of kind "simulate" or "optimize"; all other members may be missing or of
/// another type. `name` stands for the file in messages. Throws InvalidInput for anything else.
[[nodiscard]] nlohmann::json parse_closing(std::string_view content, const std::string& name);
/// Throws InvalidInput unless the JSON of a result has figures of merit and a scene, which a report needs.
void require_reportable(const nlohmann::json& record);
/// Returns the results of a closing from their JSON. Every part is optional: a part that is missing, null or of another type is
/// not available. Throws InvalidInput when `from` is not an object.
[[nodiscard]] ClosingRecord read_closing(const nlohmann::json& from);

namespace internal {
/// Returns a number that was computed with several numbers of modes, as JSON: {"5": number, "10": ..., "20": ..., "converged":
/// number}; a number that is not available is null.
[[nodiscard]] nlohmann::json by_modes_json(const ByModes& found);
[[nodiscard]] std::optional<ByModes> read_by_modes(const nlohmann::json& found);
}  // namespace internal

/// Returns the curve of a run as CSV with the header time_s,tip_gap_m,tip_velocity_m_s,contact_force_N,contact_resistance_ohm
/// (the columns that exist). A number is the shortest text that reads back to the same bits; a non-finite value is an empty
/// field.
[[nodiscard]] std::string trajectory_csv(const CurveRecord& curve);

}  // namespace softland
