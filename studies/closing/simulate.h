// One closing, with figures of merit and their errors, at the requested accuracy of the scene.
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

/// The run that judges another: a hundredth of its tolerance, twice its quadrature points. If rounding leaves no room for that,
/// or such a run fails, a hundred times its tolerance: the difference is then the integration error of the judge.
struct Judge {
  Status status = Status::not_run;
  bool came_to_its_end = false;
  std::string message = {};  ///< reason if it did not
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
  bool is_thinned = false;             ///< the trajectory lacks knots: it serves plots only (CourseRecorder)
  std::vector<Rebound> rebounds = {};  ///< rebounds of all knots until the command to open, if there is one
  Metrics metrics;
  std::optional<OpenCommand> command = {};    ///< command of the drives to open the switch
  std::vector<ContactClosing> contacts = {};  ///< ordered as Trajectory::contacts; empty for a single contact
  /// Absolute error estimates: the difference to the judge's figures plus rounding, for the drive energy at least the residual
  /// of the energies, or the errors of certify(). NaN if not estimated. Only certify() estimates those of t_p, t_b and N_B, and
  /// of everything after the runs part in a rebound's height, since no two runs tell the range of a chaotic figure.
  FigureValues errors;
  double tolerance = 0;        ///< tolerance of the integrator, in the run of the figures
  SwitchOptions quadrature;    ///< quadrature of that run
  std::optional<Judge> judge;  ///< judge of that run, if errors are estimated
  /// True for a touch that does not last: the hold levels neither keep the switch closed (its closed equilibrium is unstable,
  /// or does not exist) nor leave it an open equilibrium to return to.
  bool is_pulled_through = false;
  std::vector<std::string> warnings;                    ///< warnings of the scene, of the laws, and of ill-conditioned figures
  std::shared_ptr<const Certificate> certificate = {};  ///< set by certify() only
};

/// Factor of a stated error over the difference of two runs, of which the tighter one errs as well.
inline constexpr double stated_safety = 2;

/// True if the figures of a run can be judged by another: it ran through its window, or it touched and then collapsed onto the
/// electrode, which leaves t_i and v_i.
[[nodiscard]] bool came_to_its_end(const Trajectory& run);

/// Raises the error of the drive energy to the residual of the energy balance, which the drives may have given.
void allow_for_residual(FigureValues& errors, const Trajectory& run);

/// Peak contact force that counts as none [N]: a hundredth of the force that bends the beam by the contact gap.
[[nodiscard]] double least_peak_force(const PreparedScene& prepared);

/// Sets peak voltage and peak slew of these drives in the window.
void set_drive_figures(Metrics& metrics, const PreparedScene& prepared, const std::vector<Signal>& signals);

/// Runs the scene's own waveforms. With `estimate_errors` a second, tighter run measures the error of each figure. A scene may
/// ask for an accuracy that t_i, v_i, B_H or the peak force do not have (relative; B_H to at least the significant rebound, the
/// force to at least least_peak_force()). Tolerance and quadrature are then tightened until they have it, or until that no
/// longer helps, and the figures are those of the tightest run. No run is its own judge, and no error is 0. After a stop the
/// status of the figures is interrupted: they are those of the last complete run, without errors, or of the finished part of
/// the first one. A switch that is not held (see set_hold()) has not settled, however quiet it is at the end of the window.
/// A switch that its drives command to open (open_command.h) has the figures of its landing until then, with the hold force
/// under the levels before the command. The opening has its own figures: the run is done if it landed and settled before, and
/// is open and at rest at the end. A run that began closed (PreparedScene::start()) has no figures of a landing, and is done if
/// it ends open and at rest. The status is collapsed_at_rest if the state in which it has to begin does not exist, and the
/// message names the other one. A run that has not touched, and was not meant to (see stays_open()), has the status `open`.
[[nodiscard]] Closing simulate(const PreparedScene& prepared, bool estimate_errors, const Watch& watch = {});

}  // namespace softland
