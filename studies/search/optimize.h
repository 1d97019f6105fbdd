// The search for a drive waveform: from a scene, through the plain step as baseline and a search, to a verified waveform.
//
// The best candidate is read back from the text of best.toml and verified by a simulation over the scene's whole simulated time
// at its accuracy. Simulations with a tighter integrator and with two more modes confirm the result. If a candidate fails one
// of these simulations, the next best is tried. The scene's own waveform and the given starts are candidates too, so that
// refining a waveform never makes it worse. Baseline and scores: search_setting.h.
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

/// Progress of a running search for a waveform.
struct OptimizeProgress {
  long evaluations = 0;
  /// Least cost in the search so far; NaN before a waveform was feasible.
  double best_cost = std::numeric_limits<double>::quiet_NaN();
  double baseline_cost = std::numeric_limits<double>::quiet_NaN();
  /// Number of evaluations that the whole search will make, reduced if closings are slow (OptimizeOptions::counts_work); 0:
  /// max_evaluations.
  long planned = 0;
};

/// The estimated work of a search.
struct SearchEstimate {
  double closing = 0;      ///< computing time of one closing of the nominal device on this machine [s]
  long evaluations = 0;    ///< number of evaluations of candidate waveforms on the nominal device
  long closings = 0;       ///< number of closings of varied devices; 0: none
  bool has_fewer = false;  ///< true if the search makes fewer closings than usual because each closing is slow
  double seconds = 0;      ///< estimated processor time of the whole search [s]
};

/// Returns the default number of evaluations. With this number the searches from every tried seed found a bounce-free waveform,
/// for the shipped scenes and their variants. A piezo needs more evaluations than an electrode; a target whose cost differs
/// from that of `bounce` gets 1.5 times as many as `bounce`.
[[nodiscard]] long default_budget(const Aim& target, Shaped drives);

/// Evaluation::index of waveforms that the user gave: the scene's own waveform and OptimizeOptions::starts.
inline constexpr long given_index = -1;

struct OptimizeOptions {
  Aim target = Target::bounce;
  /// Conditions on figures among conditioned_figures that the found waveform must fulfil.
  std::vector<Condition> conditions = {};
  Actuator actuator = Actuator::electrostatic;
  /// Waveform families to search, see families_of(); the best waveform of all families is the result.
  std::string family = "pulse";
  /// Waveforms from the user's code that `family` may name. They have no gradients, and no scene file can contain them.
  OwnWaveforms own_waveforms = {};
  std::string optimizer = "auto";
  long max_evaluations = 2500;  ///< number of evaluations of candidate waveforms, see default_budget()
  /// Number of further evaluations near the best points, if no closing without a significant rebound was found.
  long more_evaluations = 0;
  /// true: max_evaluations is meant for closings of average computing time; the search makes fewer evaluations if its closings
  /// are slow (search_budget.h).
  bool counts_work = false;
  /// true: the search begins exactly as with half the budget, and continues from that result, so that twice the budget is never
  /// worse. Use this to compare budgets; an undivided search finds more. The budget must be in evaluations, not in seconds.
  bool begins_with_half = false;
  double max_seconds = std::numeric_limits<double>::infinity();  ///< time budget of the whole search [s]
  std::uint64_t seed = 1;
  int jobs = 1;
  /// Waveforms of the searched drives, for example from other searches. The waveforms are candidates, and the search starts at
  /// the nearest point of each waveform family.
  std::vector<StartingWaveforms> starts = {};
  /// true: some of the candidate waveforms that make contact are kept in OptimizeResult::tried: the best, and a selection with
  /// higher costs, of every waveform family.
  bool keep_tried = false;
  /// Gives the costs of candidate waveforms that were simulated before, and stores the costs of new candidates; may be null.
  EvaluationMemory* memory = nullptr;
  /// Flag that another thread sets (Ctrl-C) to end the search. The best candidate waveform so far is still verified and
  /// confirmed.
  const std::atomic<bool>* stop = nullptr;
  /// Function that receives the progress of the computations before and after the search: pull-in voltages, baseline, and
  /// verification of the best waveform. See base/progress.h.
  std::function<void(std::string_view what, double part)> on_preparation = {};
  /// Function that is called once before the first evaluation, when scene and options are valid, with the searched parameters
  /// of every waveform family. Evaluation::problem is the index of a family. A budget of time excludes the duration of this
  /// call.
  std::function<void(const FamilyColumns&)> on_start = {};
  /// Function that is called once before on_start with the estimated work; may be null.
  std::function<void(const SearchEstimate&)> on_estimate = {};
  /// Function that is called under a lock after every evaluation of a candidate waveform.
  std::function<void(const Evaluation&, const OptimizeProgress&)> on_evaluation = {};
  /// Function that is called under the lock of on_evaluation after an evaluation on only some of the varied devices, for which
  /// on_evaluation is not called.
  std::function<void(const OptimizeProgress&)> on_progress = {};
  /// Function that is called under the lock of on_evaluation at every improvement under which the switch makes contact, with a
  /// scene of the improving waveform. The first may be the scene's own waveform or one of `starts`, with the index given_index
  /// and, if the waveform family cannot describe that waveform, an empty x. Not called for own_waveforms, which no scene file
  /// can contain.
  std::function<void(const Evaluation&, const SceneFile&)> on_improvement = {};
};

/// Returns the default options of a search on the nominal device: the waveform families and the budget that suit target,
/// actuator and scene, as of `softland optimize SCENE --robust none` on one thread.
[[nodiscard]] OptimizeOptions usual_options(const SceneFile& scene, const Aim& target = Target::bounce,
                                            Actuator actuator = Actuator::electrostatic);

/// The result of the search within one waveform family.
struct SearchedFamilyResult {
  std::string family;
  long evaluations = 0;
  /// Least target cost found in the waveform family; NaN if no waveform was feasible.
  double cost = std::numeric_limits<double>::quiet_NaN();
};

/// A candidate waveform that was simulated on the nominal device.
struct TriedWaveform {
  std::string family;
  double cost = 0;
  DriveWaveforms waveforms;  ///< waveforms of the searched drives [V]
};

struct OptimizeResult {
  PreparedScene scene;  ///< the scene that the user gave
  PreparedScene baseline_scene;
  Closing baseline;
  /// The scene of best.toml, with the best waveform; none if there is no best waveform.
  std::optional<PreparedScene> best_scene;
  std::optional<Closing> best;
  std::vector<CheckingRun> checks;
  std::vector<SearchedFamilyResult> families = {};  ///< results of the searched waveform families
  std::string family;                               ///< waveform family of the best waveform
  std::string prefix;  ///< prefix of the waveform family in the names of searched_columns(): see prefix_of()
  std::map<std::string, double> parameters;  ///< waveform parameters of the best waveform, by drive.name
  std::vector<Variable> variables;           ///< variables (parameters with bounds) of the waveform family `family`
  double best_cost = std::numeric_limits<double>::quiet_NaN();
  double baseline_cost = std::numeric_limits<double>::quiet_NaN();
  /// Evaluations of the search; their points are parameters of the waveform family with the index Evaluation::problem.
  OptimizerResult search;
  bool goal_met = false;
  bool confirmed = false;  ///< true if the best waveform also meets the goal with a tighter integrator and with more modes
  /// Number of evaluations of the search's continuations with slower edges and with several numbers of modes: they follow if
  /// the found waveforms were bounce-free only with the scene's number of modes.
  long evaluations_of_modes = 0;
  bool better_than_baseline = false;
  /// True if the plain step is the result: it closes without a bounce, and all other candidates close harder or no better.
  bool plain_step_wins = false;
  /// Largest relative excess of the best closing's impact velocity, peak force or impact energy over the plain step's: see
  /// hardness_beyond_step().
  double harder_than_step = 0;
  /// True if the best waveform meets the goal or is better than the plain step.
  [[nodiscard]] bool is_success() const { return best && !best->is_pulled_through && (goal_met || better_than_baseline); }
  std::vector<std::string> broken_conditions = {};  ///< texts of the conditions that the best waveform does not fulfil
  std::vector<TriedWaveform> tried = {};            ///< candidate waveforms that were simulated, see OptimizeOptions::keep_tried

  /// Returns the best waveform's value of the parameter `name`, one of searched_columns(); NaN if the best waveform's family
  /// lacks the parameter, or if there is no best waveform.
  [[nodiscard]] double parameter(std::string_view name) const;
};

/// Searches for a drive waveform. Throws InvalidInput for a scene or options that cannot be searched, before on_start is
/// called. Numerical failures are reported in the result.
[[nodiscard]] OptimizeResult optimize(const SceneFile& file, const OptimizeOptions& options);

/// Goal of the target `settling`: largest ratio of the contact's settling time to the time of first contact under the plain
/// step. On the shipped gold cantilevers the goal is about 1.1 times the best ratio that pulse waveforms have reached.
inline constexpr double settling_goal = 1.3;

/// Returns the largest relative excess of a closing over the plain step, in impact velocity, peak contact force or impact energy;
/// 0 if the excess is at most a thousandth.
[[nodiscard]] double hardness_beyond_step(const Metrics& closing, const Metrics& step);

/// True if the closing `best` meets the goal of the target. For a user objective from Aim::from_the_start() the switch must
/// make contact with a lower objective than the baseline. For all other targets the contact must settle without a significant
/// rebound. For `settling` it must also settle within settling_goal, or before the baseline does, if the baseline does not
/// touch. For other targets whose cost differs from that of bounce, and for sums of targets, their figure must also be better
/// than the baseline's. The figure of a sum is the weighted mean of the figures relative to the baseline.
[[nodiscard]] bool goal_met(const Aim& target, const Metrics& best, const Metrics& baseline);

}  // namespace softland
