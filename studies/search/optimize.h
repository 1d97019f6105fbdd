// The search for a drive waveform: scene -> baseline -> search -> verified winner.
//
// The winner is believed only after a run over the whole window at the scene's accuracy, read back from the very text of
// best.toml; runs with a tighter integrator and with two more modes confirm it. Where the best candidate fails one of these, the
// next ones of the search are tried. The waveform that the scene holds already, and those it is told to start with, are
// candidates too, so that refining a winner never ends with a worse one. Baseline and scores: search_setting.h.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/criterion.h"
#include "objectives/cost.h"
#include "optimizers/problem.h"
#include "studies/closing/confirmation.h"
#include "studies/closing/simulate.h"
#include "studies/search/evaluation_memory.h"
#include "studies/search/search_space.h"

namespace softland {

/// What is known while a search runs.
struct OptimizeProgress {
  long evaluations = 0;
  double best_cost = std::numeric_limits<double>::quiet_NaN();  ///< NaN before a waveform was feasible
  double baseline_cost = std::numeric_limits<double>::quiet_NaN();
  long planned = 0;  ///< evaluations of the whole search, where its budget counts work; 0: OptimizeOptions::max_evaluations
};

/// The work that a search is going to be.
struct SearchEstimate {
  double closing = 0;      ///< time of one closing of the nominal device on this machine [s]
  long evaluations = 0;    ///< evaluations of the nominal device
  long closings = 0;       ///< closings of devices; 0: none
  bool has_fewer = false;  ///< than a scene of usual closings
  double seconds = 0;      ///< processor time of the whole search [s]
};

/// Evaluations that found bounce-free waveforms from every seed tried, on the shipped scenes and their variants: the landscape of
/// a weak piezo is the harder one. A target with a cost of its own has half as much again for it, after the same search as
/// `bounce`.
[[nodiscard]] long default_budget(const Aim& target, Shaped drives);

/// Evaluation::index of the scene's own waveform, and of those to start with.
inline constexpr long given_index = -1;

struct OptimizeOptions {
  Aim target = Target::bounce;
  /// That the winner has to fulfil, on figures of all_figures: see conditioned_figures.
  std::vector<Criterion> conditions = {};
  Actuator actuator = Actuator::electrostatic;
  std::string family = "pulse";  ///< or several, see families_of(): of these the best; default_families()
  /// That `family` names beside the families. Their gradients are not known; and no scene file holds what is found.
  OwnWaveforms own_waveforms = {};
  std::string optimizer = "auto";
  long max_evaluations = 2500;  ///< see default_budget()
  /// Evaluations on top of those, from the best points so far, where they have found no landing without a significant rebound.
  long more_evaluations = 0;
  /// These numbers are of usual closings: where closings take more work there are fewer (search_work.h).
  bool counts_work = false;
  /// The search begins with that of half the budget, to the bit, and goes on from there: it ends nowhere worse. For budgets that
  /// are compared; an undivided one finds more. Of a number of evaluations, not of seconds.
  bool begins_with_half = false;
  double max_seconds = std::numeric_limits<double>::infinity();  ///< [s]
  std::uint64_t seed = 1;
  int jobs = 1;
  /// Landings that other searches have found: candidates, and first points of this one, as near as a family comes to them. They
  /// must be of the drives that are searched.
  std::vector<StartingWaveforms> starts = {};
  /// Keep some of the candidates that touch: the best, and those of ever higher cost, of every family.
  bool keep_tried = false;
  /// What is known of candidates already, and learns of those that are simulated; may be null.
  EvaluationMemory* memory = nullptr;
  /// Set from outside (Ctrl-C): ends the search. The runs that verify and confirm what it found by then are run to their end.
  const std::atomic<bool>* stop = nullptr;
  /// Told before and after the search itself, of the pull-in voltages, the baseline and the runs that verify the winner: see
  /// Watch.
  std::function<void(std::string_view what, double part)> on_preparation = {};
  /// Called once, when scene and options have been found valid and before the first evaluation, with the searched
  /// parameters of every family, whose number is Evaluation::problem. A budget of time does not count what it takes.
  std::function<void(const FamilyColumns&)> on_start = {};
  /// Called once before on_start; may be null.
  std::function<void(const SearchEstimate&)> on_estimate = {};
  /// Called under a lock after every evaluation.
  std::function<void(const Evaluation&, const OptimizeProgress&)> on_evaluation = {};
  /// Called under the same lock where a search is at work that is not on record, as on a part of the devices.
  std::function<void(const OptimizeProgress&)> on_progress = {};
  /// Called under the same lock at every improvement that touches, with the scene file that gives it. The first may be the
  /// scene's own waveform, or one of `starts`, before the search: their index is given_index, and x is empty where the searched
  /// family cannot describe it. Not called for own waveforms, which no scene can hold.
  std::function<void(const Evaluation&, const SceneFile&)> on_improvement = {};
};

/// What a search on the nominal device is asked for where nothing else is said: the families and the budget that suit target,
/// actuator and scene. That of `softland optimize SCENE --robust none` on one thread.
[[nodiscard]] OptimizeOptions usual_options(const SceneFile& scene, const Aim& target = Target::bounce,
                                            Actuator actuator = Actuator::electrostatic);

/// What the search within one family came to.
struct SearchedFamilyResult {
  std::string family;
  long evaluations = 0;
  double cost = std::numeric_limits<double>::quiet_NaN();  ///< the least; NaN where nothing was feasible
};

/// A candidate that was tried on the nominal device.
struct TriedWaveform {
  std::string family;
  double cost = 0;
  DriveWaveforms waveforms;  ///< of the searched drives [V]
};

struct OptimizeResult {
  PreparedScene scene;  ///< as given
  PreparedScene baseline_scene;
  Closing baseline;
  std::optional<PreparedScene> best_scene;  ///< what best.toml says
  std::optional<Closing> best;
  std::vector<ConfirmingRun> checks;
  std::vector<SearchedFamilyResult> families = {};  ///< that were searched
  std::string family;                               ///< of the winner
  std::string prefix;                               ///< of its parameters among those of all families: prefix_of()
  std::map<std::string, double> parameters;         ///< of the winner, by drive.name
  std::vector<Variable> variables;                  ///< of the winner's family, and within which bounds they were searched
  double best_cost = std::numeric_limits<double>::quiet_NaN();
  double baseline_cost = std::numeric_limits<double>::quiet_NaN();
  OptimizerResult search;  ///< points are of the family that is Evaluation::problem
  bool goal_met = false;
  bool confirmed = false;  ///< the goal is met with a tighter integrator and with more modes too
  /// Evaluations on top of the search's, each with all these numbers of modes, where its landings belonged to those of the scene.
  long evaluations_of_modes = 0;
  bool better_than_baseline = false;
  bool plain_step_wins = false;  ///< the winner is the plain step, which lands; what else was found is harder or no better
  double harder_than_step = 0;   ///< hardness_beyond_step() of the winner
  /// A goal that is met is a success, whatever the plain step does.
  [[nodiscard]] bool is_success() const { return best && !best->is_pulled_through && (goal_met || better_than_baseline); }
  std::vector<std::string> broken_conditions = {};  ///< by the winner
  std::vector<TriedWaveform> tried = {};            ///< see OptimizeOptions::keep_tried

  /// The winner's value of one of the names of searched_columns(); NaN where its family has no such parameter, or there is no
  /// winner.
  [[nodiscard]] double parameter(std::string_view name) const;
};

/// Throws InvalidInput for a scene or options that cannot be searched, before on_start is called. Numerical trouble is in the
/// result.
[[nodiscard]] OptimizeResult optimize(const SceneFile& file, const OptimizeOptions& options);

/// The goal of `settling`: permanent contact within so many times the first touch of the plain step. On the shipped gold
/// cantilevers this is about 1.1 times the best that is known of pulses.
inline constexpr double settling_goal = 1.3;

/// By how much a closing exceeds the plain step in touch speed, peak contact force or impact energy, as a share of the step's; 0
/// where that is no more than a thousandth.
[[nodiscard]] double hardness_beyond_step(const Metrics& closing, const Metrics& step);

/// Goal of every target: settled without a significant rebound; settling: soon enough, too, or before the baseline where that
/// does not touch; the others with a cost of their own, and sums: their own figure is also better than the baseline's. Of a sum
/// it is the weighted mean of the figures over those of the baseline.
[[nodiscard]] bool goal_met(const Aim& target, const Metrics& best, const Metrics& baseline);

}  // namespace softland
