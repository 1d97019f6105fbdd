// One closing, with figures of merit and their errors, at the accuracy that the scene requests.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "model/closing.h"
#include "objectives/figure_values.h"
#include "studies/closing/hold.h"
#include "studies/closing/open_command.h"
#include "studies/closing/prepared.h"

namespace softland {

struct Certificate;

/// The run that judges another run: the errors of the other run are estimated from the difference. The judge has a hundredth of
/// the tolerance of the other run and twice its quadrature points. If rounding forbids that, or such a run fails, the judge has
/// a hundred times the tolerance, and the difference is the integration error of the judge.
struct Judge {
  Status status = Status::not_run;
  bool came_to_its_end = false;
  std::string message = {};  ///< reason why the run of the judge is not complete; empty if it is complete
  Metrics metrics;
  double tolerance = 0;
  SwitchOptions quadrature;
};

/// The figures of one of several contacts in a closing.
struct ContactClosing {
  Metrics metrics;
  std::vector<Rebound> rebounds;
};

struct Closing {
  Trajectory trajectory;
  /// True if knots (points between integrator steps) are left out, so that the trajectory suffices for plots only.
  bool is_thinned = false;
  /// Rebounds found in all knots (points between integrator steps), up to the command to open if there is one.
  std::vector<Rebound> rebounds = {};
  Metrics metrics;
  std::optional<OpenCommand> command = {};  ///< command to open that the drive signals give; none without a command
  /// Figures of each contact, ordered as Trajectory::contacts; empty for a single contact.
  std::vector<ContactClosing> contacts = {};
  /// Absolute error estimates: the difference to the judge's figures plus rounding, or the errors of certify(). The error of
  /// the drive energy is at least the residual of the energy balance. NaN if not estimated. Two runs do not give the range of a
  /// chaotic figure. So only certify() estimates the errors of permanent contact time, bounce time and bounce count, and of
  /// figures of the motion after the two runs differ in the height of a rebound.
  FigureValues errors;
  double tolerance = 0;      ///< relative tolerance of the integrator in the run that gave the figures
  SwitchOptions quadrature;  ///< quadrature along the beam in the run that gave the figures
  /// More accurate run from which the errors of the figures follow; none if errors are not estimated.
  std::optional<Judge> judge;
  /// True for a contact that does not last: under the hold levels the switch has neither a stable closed equilibrium nor an
  /// open equilibrium to which it can return.
  bool is_pulled_through = false;
  std::vector<std::string> warnings;  ///< warnings of the scene, of the laws, and of ill-conditioned figures
  /// Ill-conditioned figures with their ranges over perturbed runs; set by certify() only.
  std::shared_ptr<const Certificate> certificate = {};
};

/// Ratio of a stated error of a figure to the difference of two runs. The ratio is above 1 because the tighter run has an error
/// as well.
inline constexpr double stated_safety = 2;

/// True if the figures of a run can be compared with those of another run: the run is complete, or the beam collapsed onto the
/// electrode after contact, so that contact time and impact velocity are known.
[[nodiscard]] bool came_to_its_end(const Trajectory& run);

/// Raises the error of the drive energy to the residual of the energy balance, since the whole residual may be an error of the
/// drive energy.
void allow_for_residual(FigureValues& errors, const Trajectory& run);

/// Returns the peak contact force that counts as zero [N]: a hundredth of the force that bends the beam by the contact gap.
[[nodiscard]] double least_peak_force(const PreparedScene& prepared);

/// Sets the peak voltage and the peak slew rate of these drive signals within the simulated time.
void set_drive_figures(Metrics& metrics, const PreparedScene& prepared, const std::vector<Signal>& signals);

/// Simulates the scene's own waveforms. With `estimate_errors` a second, tighter run gives the error of each figure.
/// - Accuracy: if contact time, impact velocity, highest rebound or peak force miss the accuracy that the scene requests,
///   tolerance and quadrature are tightened until all reach it or until tightening no longer helps. The figures are those of
///   the tightest run. Errors are relative; that of the rebound is relative to at least the significant rebound, that of the
///   force to at least least_peak_force(). No run is its own judge, and no error is 0.
/// - Interruption: the status of the figures is interrupted. The figures are those of the last complete run, without errors, or
///   of the finished part of the first run.
/// - Hold: a switch that its hold levels do not keep closed has not settled, even if it is at rest at the end of the simulated
///   time.
/// - Command to open (open_command.h): until the command the switch has the figures of its closing, with the hold force under
///   the levels before the command. The opening has its own figures. The run is done if the switch settled closed before the
///   command, and is open and at rest at the end.
/// - Closed start (PreparedScene::start()): the run has no figures of a closing, and is done if the switch ends open and at
///   rest.
/// - The status is collapsed_at_rest if the start state of the run does not exist. The message names the other start state.
/// - The status is `open` if the switch made no contact and its drives are not meant to close it (stays_open()).
[[nodiscard]] Closing simulate(const PreparedScene& prepared, bool estimate_errors, const Progress& progress = {});

}  // namespace softland
