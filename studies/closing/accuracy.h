// The cost of accuracy on the user's own scene: the errors of the delivered figures of merit, not of a step. They are given
// against time and right-hand sides, for every integrator, tolerance, number of quadrature points and number of modes.
//
// The reference has a ten-thousandth of the tightest tolerance and twice the most quadrature points, or as near to that as its
// time allows. Settings that are no looser than it are then not tried. A rigid plate has the same gap everywhere: it has no
// quadrature to study. Drives keep the volts that the scene gives them, whatever the number of modes. The effect of another
// number of modes is a matter of the model, not an error of the integration, and is reported separately. So are runs whose
// integrator is not restarted at the contact: simulate() restarts it. Figures that imperceptible perturbations of the drives
// move visibly have no error: they are shown as the range of a cloud of runs.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "model/closing.h"
#include "objectives/figures.h"
#include "studies/closing/cloud.h"
#include "studies/closing/prepared.h"

namespace softland {

/// Errors of `studied_figures`, in their order.
using FigureErrors = std::array<double, studied_figures.size()>;

/// relative_difference() of each studied figure as it is counted; NaN for a figure that the reference does not have.
[[nodiscard]] FigureErrors relative_errors(const Metrics& value, const Metrics& reference, const MetricsOptions& options);

struct AccuracyOptions {
  std::vector<double> tolerances{1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};  ///< tolerances from loose to tight
  std::vector<double> points{6, 8, 12, 16, 24, 48};                          ///< per length, ascending
  std::vector<double> wanted{1e-2, 1e-3, 1e-4, 1e-5, 1e-6};                  ///< accuracies to recommend a setting for
  int runs = 7;                   ///< timed runs, whose median is taken; fewer if they take long
  double most_seconds = 2;        ///< limit for one closing; a slower one is cut, and tighter ones are not tried
  double reference_seconds = 10;  ///< limit for the references, from loose to tight; longer ones are not run
  double all_seconds = 15;        ///< limit for everything else; later settings are not tried
  std::function<void(std::size_t done, std::size_t of)> on_progress = {};
  const std::atomic<bool>* stop = nullptr;
  std::function<double()> clock = wall_clock;  ///< clock for all these limits [s]; read once in 64 steps
};

/// One setting and its results.
struct AccuracyRow {
  Integrator integrator = Integrator::automatic;
  double tolerance = 0;
  std::optional<double> points_per_length = {};  ///< none for a plate
  int modes = 0;
  bool restart = true;       ///< restart of the integrator, at make and break of contact
  std::string missing = {};  ///< reason for missing figures; empty if there are figures
  Metrics figures = {};
  FigureErrors errors = {};  ///< relative errors, against the reference
  Work work = {};
  double seconds = Metrics::unset;  ///< median processor time of one closing
  int runs = 0;                     ///< number of timed runs
};

/// The quickest setting that is within an accuracy. Tighter tolerances of the same setting must be so too, which excludes lucky
/// hits.
struct Recommendation {
  double accuracy = 0;
  std::optional<std::size_t> row;  ///< index of AccuracyStudy::rows; none: no tried setting is that accurate
};

struct AccuracyStudy {
  Status status = Status::not_run;  ///< status of the reference; without contact there is nothing to study
  std::string message = {};         ///< reason for a missing reference, or one looser than planned
  AccuracyRow reference;
  /// Relative difference to a second reference, with a hundred times its tolerance and half its points: errors below it are not
  /// resolved.
  FigureErrors resolution = {};
  /// Settings with the integrator that simulate takes: every tolerance and number of points, the points that simulate takes
  /// first. The other integrators have every tolerance at those points.
  std::vector<AccuracyRow> rows;
  std::vector<AccuracyRow> modes;    ///< other numbers of modes, at the tightest tolerance
  std::vector<AccuracyRow> through;  ///< every integrator and tolerance, without a restart at make and break of contact
  std::string why_always_restarted;  ///< reason for missing runs of that kind
  std::array<Spread, studied_figures.size()> cloud;      ///< spreads over perturbed runs at the tightest tolerance
  Spread permanent_contact_time, bounce_count;           ///< spreads over the same runs
  std::array<bool, studied_figures.size()> conditioned;  ///< true for a figure that has errors at all
  std::vector<Recommendation> recommendations;

  /// Largest error of the well-conditioned figures; NaN if a row has none.
  [[nodiscard]] double worst_error(const AccuracyRow& row) const;
};

[[nodiscard]] AccuracyStudy study_accuracy(const PreparedScene& prepared, const AccuracyOptions& options = {});

}  // namespace softland
