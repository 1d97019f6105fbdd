// The cost of accuracy on the user's own scene. An accuracy study gives the error of every reported figure of merit (not of a
// single integration step) against computing time and evaluations of the right-hand side, for every integrator, tolerance,
// number of quadrature points and number of modes.
//
// The reference run has a ten-thousandth of the tightest tolerance and twice the largest number of quadrature points, or the
// nearest values that its time limit allows. Settings that are as tight as the reference, or tighter, are skipped.
// - A rigid plate has the same gap everywhere, so the study varies no quadrature for it.
// - The applied voltages stay the same for every number of modes, although the pull-in voltages, their units, differ.
// - The effect of another number of modes is a property of the model, not an integration error, and is reported separately.
// - Runs whose integrator is not restarted at the contact are also reported separately: simulate() always restarts it.
// - A figure that changes visibly under imperceptible perturbations of the drives has no error. Its range over a cloud of
//   perturbed runs is given instead.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/closing.h"
#include "objectives/figure_values.h"
#include "studies/closing/cloud.h"
#include "studies/closing/prepared.h"
#include "studies/closing/timing.h"

namespace softland {

/// Errors of the figures in `studied_figures`, in the same order.
using FigureErrors = std::array<double, studied_figures.size()>;

/// Returns the relative_difference() of each studied figure from that of `reference`; NaN for a figure that `reference` lacks.
/// Rebounds below the significant height count as equal (Figure::counted()).
[[nodiscard]] FigureErrors relative_errors(const Metrics& value, const Metrics& reference, const MetricsOptions& options);

struct AccuracyOptions {
  /// Relative tolerances of the integrator, from loose to tight.
  std::vector<double> tolerances{1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};
  std::vector<double> points{6, 8, 12, 16, 24, 48};  ///< numbers of quadrature points over the beam's length, ascending
  /// Accuracies (relative errors of figures) for each of which a setting is recommended.
  std::vector<double> wanted{1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
  int runs = 7;  ///< number of timed runs of a setting, whose median is reported; fewer if the runs take long
  /// Limit of `clock` for one closing [s]; a longer closing is stopped, and tighter tolerances are skipped.
  double most_seconds = 2;
  /// Limit of `clock` for the reference runs [s], in order from loose to tight; later runs are skipped.
  double reference_seconds = 10;
  double all_seconds = 15;  ///< limit of `clock` for all runs other than references [s]; later settings are skipped
  std::function<void(std::size_t done, std::size_t of)> on_progress = {};
  const std::atomic<bool>* stop = nullptr;
  /// Clock that measures the time limits [s]; it is read once in 64 steps of the integrator. The processor time of the thread
  /// does not depend on what else the machine computes.
  std::function<double()> clock = processor_seconds;
};

/// One setting of the integrator and the discretisation, with its results.
struct AccuracyRow {
  Integrator integrator = Integrator::automatic;
  double tolerance = 0;
  std::optional<double> points_per_length = {};  ///< quadrature points over the length of the beam; none for a rigid plate
  int modes = 0;
  bool restart = true;       ///< true if the integrator is restarted at make and break of contact
  std::string missing = {};  ///< reason why the run has no figures; empty if the figures exist
  Metrics figures = {};
  FigureErrors errors = {};  ///< relative errors of the figures against the reference run
  Work work = {};
  double seconds = Metrics::unset;  ///< median processor time of one closing [s]
  int runs = 0;                     ///< number of timed runs of this setting
};

/// The fastest setting whose errors are within an accuracy. Its errors at tighter tolerances must be within this accuracy as
/// well, which excludes settings that are accurate by chance.
struct Recommendation {
  double accuracy = 0;
  /// Index in AccuracyStudy::rows of the recommended setting; none if no simulated setting is accurate enough.
  std::optional<std::size_t> row;
};

struct AccuracyStudy {
  Status status = Status::not_run;  ///< status of the reference run; a scene without contact cannot be studied
  std::string message = {};         ///< reason for a missing reference run, or for one that is looser than planned
  AccuracyRow reference;
  /// Relative difference of the figures between the reference run and a second reference run, with a hundred times the
  /// tolerance and half the quadrature points. Errors below this difference are not resolved.
  FigureErrors resolution = {};
  /// Runs with the integrator that simulate() uses, for every tolerance and number of quadrature points, beginning with the
  /// number that simulate() uses. Other integrators run with this number of quadrature points only, for every tolerance.
  std::vector<AccuracyRow> rows;
  std::vector<AccuracyRow> modes;  ///< runs with other numbers of modes than the scene, at the tightest tolerance
  /// Runs without restart of the integrator at make and break of contact, for every integrator and tolerance.
  std::vector<AccuracyRow> through;
  std::string why_always_restarted;  ///< reason why there are no runs without restart of the integrator
  /// Ranges of the figures in studied_figures over runs with imperceptibly perturbed drives.
  std::array<Spread, studied_figures.size()> cloud;
  Spread permanent_contact_time, bounce_count;  ///< ranges of the two named figures over the same perturbed runs as `cloud`
  /// True for each of studied_figures that is well-conditioned, so that its error is meaningful.
  std::array<bool, studied_figures.size()> conditioned;
  std::vector<Recommendation> recommendations;

  /// Returns the largest error of the well-conditioned figures in a row of the study; NaN if the row lacks one of these
  /// figures.
  [[nodiscard]] double worst_error(const AccuracyRow& row) const;
};

[[nodiscard]] AccuracyStudy study_accuracy(const PreparedScene& prepared, const AccuracyOptions& options = {});

}  // namespace softland
