// The search for a drive waveform: scene -> baseline -> search -> verified winner.
//
// The winner is verified by a run over the whole window at the scene's accuracy, read back from the very text of best.toml.
// Runs with a tighter integrator and with two more modes confirm it. If the best candidate fails one of these, the next ones of
// the search are tried. The waveform that the scene holds already, and the given starts, are candidates too, so that refining a
// winner never ends with a worse one. Baseline and scores: search_setting.h.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/condition.h"
#include "objectives/cost.h"
#include "optimizers/problem.h"
#include "studies/closing/checking_runs.h"
#include "studies/closing/simulate.h"
#include "studies/search/evaluation_memory.h"
#include "studies/search/search_space.h"

namespace softland {

/// State of a running search.
struct OptimizeProgress {
  long evaluations = 0;
  double best_cost = std::numeric_limits<double>::quiet_NaN();  ///< NaN before a waveform was feasible
  double baseline_cost = std::numeric_limits<double>::quiet_NaN();
  long planned = 0;  ///< evaluations of the whole search, if its budget counts work; 0: OptimizeOptions::max_evaluations
};

/// The estimated work of a search.
struct SearchEstimate {
  double closing = 0;      ///< time of one closing of the nominal device on this machine [s]
  long evaluations = 0;    ///< evaluations of the nominal device
  long closings = 0;       ///< closings of devices; 0: none
  bool has_fewer = false;  ///< fewer closings than for a usual scene
  double seconds = 0;      ///< processor time of the whole search [s]
};

/// Evaluations that found bounce-free waveforms from every seed tried, on the shipped scenes and their variants: the landscape
/// of a weak piezo is the harder one. A target with a cost of its own gets half as much again for it, after the same search as
/// for `bounce`.
[[nodiscard]] long default_budget(const Aim& target, Shaped drives);

/// Evaluation::index of the scene's own waveform, and of the given starts.
inline constexpr long given_index = -1;

struct OptimizeOptions {
  Aim target = Target::bounce;
  /// Conditions for the winner on figures of all_figures: see conditioned_figures.
  std::vector<Condition> conditions = {};
  Actuator actuator = Actuator::electrostatic;
  std::string family = "pulse";  ///< one or several families, see families_of(): the best wins; default_families()
  /// Own waveforms that `family` may name. Their gradients are not known, and no scene file can hold the result.
  OwnWaveforms own_waveforms = {};
  std::string optimizer = "auto";
  long max_evaluations = 2500;  ///< see default_budget()
  /// Further evaluations from the best points so far, if those found no landing without a significant rebound.
  long more_evaluations = 0;
  /// Numbers are of usual closings: slow closings get fewer (search_work.h).
  bool counts_work = false;
  /// The search begins with that of half the budget, to the bit, and goes on from there: it never ends worse. Use it to compare
  /// budgets; an undivided search finds more. It needs a budget of evaluations, not of seconds.
  bool begins_with_half = false;
  double max_seconds = std::numeric_limits<double>::infinity();  ///< [s]
  std::uint64_t seed = 1;
  int jobs = 1;
  /// Landings that other searches have found. They are candidates, and first points of this search, as near as a family comes
  /// to them. They must be of the searched drives.
  std::vector<StartingWaveforms> starts = {};
  /// Keeps some of the candidates that touch: the best, and those of ever higher cost, of every family.
  bool keep_tried = false;
  /// Remembers the costs of known candidates, and stores those of simulated ones; may be null.
  EvaluationMemory* memory = nullptr;
  /// Flag from outside (Ctrl-C) that ends the search. The runs that verify and confirm what it found by then are run to their
  /// end.
  const std::atomic<bool>* stop = nullptr;
  /// Called before and after the search itself, for the pull-in voltages, the baseline and the runs that verify the winner: see
  /// Progress.
  std::function<void(std::string_view what, double part)> on_preparation = {};
  /// Called once, when scene and options have been found valid and before the first evaluation, with the searched parameters of
  /// every family, whose number is Evaluation::problem. A budget of time excludes the time that it takes.
  std::function<void(const FamilyColumns&)> on_start = {};
  /// Called once before on_start; may be null.
  std::function<void(const SearchEstimate&)> on_estimate = {};
  /// Called under a lock after every evaluation.
  std::function<void(const Evaluation&, const OptimizeProgress&)> on_evaluation = {};
  /// Called under the same lock after an evaluation that on_evaluation does not report: one on a part of the devices.
  std::function<void(const OptimizeProgress&)> on_progress = {};
  /// Called under the same lock at every improvement that touches, with the scene file that gives it. The first may be the
  /// scene's own waveform, or one of `starts`, before the search. Their index is given_index, and x is empty if the searched
  /// family cannot describe them. Not called for own waveforms, which no scene can hold.
  std::function<void(const Evaluation&, const SceneFile&)> on_improvement = {};
};

/// Returns the default options of a search on the nominal device: the families and the budget that suit target, actuator and
/// scene, as of `softland optimize SCENE --robust none` on one thread.
[[nodiscard]] OptimizeOptions usual_options(const SceneFile& scene, const Aim& target = Target::bounce,
                                            Actuator actuator = Actuator::electrostatic);

/// The result of the search within one family.
struct SearchedFamilyResult {
  std::string family;
  long evaluations = 0;
  double cost = std::numeric_limits<double>::quiet_NaN();  ///< least cost; NaN if nothing was feasible
};

/// A candidate that was tried on the nominal device.
struct TriedWaveform {
  std::string family;
  double cost = 0;
  DriveWaveforms waveforms;  ///< waveforms of the searched drives [V]
};

struct OptimizeResult {
  PreparedScene scene;  ///< the given scene
  PreparedScene baseline_scene;
  Closing baseline;
  std::optional<PreparedScene> best_scene;  ///< the scene of best.toml
  std::optional<Closing> best;
  std::vector<CheckingRun> checks;
  std::vector<SearchedFamilyResult> families = {};  ///< results of the searched families
  std::string family;                               ///< family of the winner
  std::string prefix;                               ///< prefix of its parameters among those of all families: prefix_of()
  std::map<std::string, double> parameters;         ///< parameters of the winner, by drive.name
  std::vector<Variable> variables;                  ///< variables of the winner's family, with their bounds
  double best_cost = std::numeric_limits<double>::quiet_NaN();
  double baseline_cost = std::numeric_limits<double>::quiet_NaN();
  OptimizerResult search;  ///< points are of the family Evaluation::problem
  bool goal_met = false;
  bool confirmed = false;  ///< the goal is met with a tighter integrator and with more modes too
  /// Evaluations on top of the search's, each with all these numbers of modes, if its landings belonged to those of the scene.
  long evaluations_of_modes = 0;
  bool better_than_baseline = false;
  bool plain_step_wins = false;  ///< the winner is the plain step, which lands; the other candidates are harder or no better
  double harder_than_step = 0;   ///< hardness_beyond_step() of the winner
  /// True for a goal that is met, whatever the plain step does, and for an improvement over it.
  [[nodiscard]] bool is_success() const { return best && !best->is_pulled_through && (goal_met || better_than_baseline); }
  std::vector<std::string> broken_conditions = {};  ///< conditions that the winner breaks
  std::vector<TriedWaveform> tried = {};            ///< see OptimizeOptions::keep_tried

  /// The winner's value of one of the names of searched_columns(); NaN if its family has no such parameter, or there is no
  /// winner.
  [[nodiscard]] double parameter(std::string_view name) const;
};

/// Throws InvalidInput for a scene or options that cannot be searched, before on_start is called. Numerical trouble is reported
/// in the result.
[[nodiscard]] OptimizeResult optimize(const SceneFile& file, const OptimizeOptions& options);

/// Goal of `settling`: settling time of the contact in first touches of the plain step. On the shipped gold cantilevers it is
/// about 1.1 times the best that is known of pulses.
inline constexpr double settling_goal = 1.3;

/// Excess of a closing over the plain step in touch speed, peak contact force or impact energy, as a share of the step's; 0 if
/// it is no more than a thousandth.
[[nodiscard]] double hardness_beyond_step(const Metrics& closing, const Metrics& step);

/// True if the goal of the target is met. All targets: settled without a significant rebound. Settling: also soon enough, or
/// before the baseline if that does not touch. Other targets with a cost of their own, and sums: their own figure is also
/// better than the baseline's. The figure of a sum is the weighted mean of the figures over those of the baseline.
[[nodiscard]] bool goal_met(const Aim& target, const Metrics& best, const Metrics& baseline);

}  // namespace softland
