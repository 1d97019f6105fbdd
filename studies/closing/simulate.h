// One closing, with figures of merit and their errors, as accurate as the scene asks for.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/watch.h"
#include "model/closing.h"
#include "objectives/figures.h"
#include "studies/closing/hold.h"
#include "studies/closing/open_command.h"
#include "studies/closing/prepared.h"

namespace softland {

struct Certificate;

/// The run that judges another: a hundredth of its tolerance, twice its quadrature points. Where rounding leaves no room for
/// that, or such a run fails, a hundred times its tolerance: the difference is then the integration error of the judge.
struct Judge {
  Status status = Status::not_run;
  bool came_to_its_end = false;
  std::string message = {};  ///< why not
  Metrics metrics;
  double tolerance = 0;
  SwitchOptions quadrature;
};

/// One of several contacts in a closing.
struct ContactClosing {
  Metrics metrics;
  std::vector<Rebound> rebounds;
};

struct Closing {
  Trajectory trajectory;
  bool is_thinned = false;             ///< the trajectory lacks knots: it draws the picture, and no more (CourseRecorder)
  std::vector<Rebound> rebounds = {};  ///< of all knots until the command to open, where there is one
  Metrics metrics;
  std::optional<OpenCommand> command = {};    ///< where the drives command the switch to open
  std::vector<ContactClosing> contacts = {};  ///< in the order of Trajectory::contacts; empty where there is one
  /// Absolute error estimates: the difference to the judge's and what rounding leaves, that of the drive energy at least the
  /// residual of the energies, or what certify() makes of it. NaN where
  /// not estimated: t_p, t_b and N_B have none but from certify(), nor what comes after the runs part in a rebound's height,
  /// since no two runs tell the range of a chaotic figure.
  FigureValues errors;
  double tolerance = 0;        ///< of the integrator, in the run that the figures are of
  SwitchOptions quadrature;    ///< of that run
  std::optional<Judge> judge;  ///< of that run, where errors are estimated
  /// A touch that does not last: the hold levels neither keep the switch closed (its closed equilibrium is unstable, or there is
  /// none) nor leave it an open equilibrium to go back to.
  bool is_pulled_through = false;
  std::vector<std::string> warnings;                    ///< of the scene, of the laws, and of ill-conditioned figures
  std::shared_ptr<const Certificate> certificate = {};  ///< from certify() only
};

/// A stated error is this often the difference of two runs, of which the tighter one errs as well.
inline constexpr double stated_safety = 2;

/// Whether the figures of a run can be judged by another: it ran through its window, or it touched and was then pulled onto the
/// electrode, which leaves t_i and v_i.
[[nodiscard]] bool came_to_its_end(const Trajectory& run);

/// What a run misses in the balance of its energies its drives may have given: no error of the drive energy is less.
void allow_for_residual(FigureValues& errors, const Trajectory& run);

/// Below this a peak contact force is as good as none [N]: a hundredth of what bends the beam by the contact gap.
[[nodiscard]] double least_peak_force(const PreparedScene& prepared);

/// Peak voltage and peak slew of these drives in the window.
void set_drive_figures(Metrics& metrics, const PreparedScene& prepared, const std::vector<Signal>& signals);

/// Runs the scene's own waveforms. With `estimate_errors` a second, tighter run measures the error of each figure; where a scene
/// asks for an accuracy that t_i, v_i, B_H or the peak force do not have (relative; B_H to at least the significant rebound, the
/// force to at least least_peak_force()), tolerance and quadrature are tightened until they have, or until that no longer
/// helps; the figures are then those of the tightest run. No run is its own judge, and no error is 0. Asked to stop, the status
/// of the figures is interrupted: they are those of the last run that was complete, without errors, or of the part of the first
/// one that was run. A switch that is not held (see set_hold()) has not settled, however quiet it is at the end of the window.
/// A switch that its drives command to open (open_command.h) has the figures of its landing until then, with the hold
/// force under what the drives stood at, and the opening has its own: the run is done where it landed and settled before, and is
/// open and at rest at the end. A run that began closed (PreparedScene::start()) has no figures of a landing, and is done where
/// it ends open and at rest. The status is collapsed_at_rest where the state that it is to begin in does not exist, and the
/// message names the other one. One that has not touched, and was not meant to (see stays_open()), has the status `open`.
[[nodiscard]] Closing simulate(const PreparedScene& prepared, bool estimate_errors, const Watch& watch = {});

}  // namespace softland
