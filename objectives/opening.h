// Figures of merit of an opening: how a closed switch opens, and how long it vibrates afterwards. These figures are taken at
// the contact point, like those of a closing.
#pragma once

#include <limits>

#include "integrators/quintic.h"
#include "model/trajectory.h"
#include "objectives/rebounds.h"

namespace softland {

struct OpeningBand {
  double open_position = 0;  ///< position of the contact point at rest under the open levels of the drives [m]
  /// Half-width of the band about open_position [m]; the switch is settled once its contact point stays in the band.
  double width = 0;
  double drives_end = 0;  ///< time from which the drives stay at their open levels [s]
};

/// The settling of the contact point in a band about its open position.
struct BandFigures {
  /// Time from which the contact point stays in the band about its open position [s]; NaN when it is outside the band at the
  /// end.
  double settled_from = std::numeric_limits<double>::quiet_NaN();
  /// Largest excursion from the open position, away from and towards the contact [m]; 0 without one.
  double below = 0, above = 0;
  /// Largest distance from the open position after OpeningBand::drives_end [m].
  double residual = std::numeric_limits<double>::quiet_NaN();
};

/// Computes BandFigures from the distance of the contact point to the open position, one turning point after another. The
/// motion between two knots (points of the simulated motion) is their quintic interpolant.
class BandFollower {
 public:
  explicit BandFollower(const OpeningBand& band) : band_(band) {}
  /// Adds the motion between two consecutive points of a trajectory.
  void follow(const TrajectoryPoint& a, const TrajectoryPoint& b);
  [[nodiscard]] BandFigures figures() const;

 private:
  void reach(double time, double position);
  void reach_end_of_drives(double position);
  void leave_band(const Quintic& curve, double from, double at_from, double to, double at_to);

  OpeningBand band_;
  bool inside_ = false;
  double settled_from_ = 0, below_ = 0, above_ = 0, residual_ = std::numeric_limits<double>::quiet_NaN();
};
[[nodiscard]] BandFigures band_figures(const Trajectory& course, const OpeningBand& band);

/// A command, during a run, to open the switch.
struct OpeningCommand {
  double time = std::numeric_limits<double>::infinity();  ///< time of the command to open [s]
  /// Rest position of the contact point under the drives' levels after the command to open [m]; NaN when no rest position
  /// exists.
  double open_position = std::numeric_limits<double>::quiet_NaN();
};

/// Figures of the opening of a closed switch on a command. Times count from the command. All figures are NaN when the contact
/// is closed at the end of the run.
struct OpeningOnCommand {
  double command = std::numeric_limits<double>::quiet_NaN();  ///< time of the command to open, counted from t = 0 [s]
  /// Time from the command to open to the last break of the contact [s].
  double opening_time = std::numeric_limits<double>::quiet_NaN();
  /// Time from the command to open after which the contact point stays within settled_band of its rest position [s].
  double settling_time = std::numeric_limits<double>::quiet_NaN();
  /// Largest excursion of the contact point beyond its open position, away from the contact [m].
  double overshoot = std::numeric_limits<double>::quiet_NaN();
  /// Smallest distance to the contact once the contact point has turned back towards it [m]; the distance at the end of the run
  /// if it never turns back.
  double least_gap = std::numeric_limits<double>::quiet_NaN();
  /// Highest separation after the command to open that ends in a touch [m]; 0 without a bounce.
  double highest_bounce = std::numeric_limits<double>::quiet_NaN();
  double separated = 0;  ///< total time in separation before the last break of the contact [s]
  /// Number of bounces on opening: separations, higher than the significant rebound, that end in a touch; meaningless when the
  /// contact is closed at the end of the run.
  int bounces = 0;
};

/// The contact point of an open switch is at rest when it stays within this share of the contact gap from its open position.
inline constexpr double settled_band = 0.02;

/// Computes the figures of an opening that is commanded during a run.
class CommandedOpening {
 public:
  /// Takes the distance `contact_gap` from rest to the contact plane and the least height `significant_rebound` of a bounce
  /// that counts [m].
  CommandedOpening(const OpeningCommand& command, double contact_gap, double significant_rebound);
  /// Adds the motion between two consecutive points of a trajectory after the command to open.
  void follow(const TrajectoryPoint& a, const TrajectoryPoint& b);
  /// Adds a separation of the contact that ended in a touch after the command to open.
  void bounce(const Rebound& rebound);
  /// Returns the figures of the opening after the run has ended at the motion point `last`. `under_way` is the separation that
  /// has not ended; none when the contact is closed.
  [[nodiscard]] OpeningOnCommand figures(const std::optional<Rebound>& under_way, const TrajectoryPoint& last) const;

 private:
  OpeningCommand command_;
  double contact_gap_, significant_;  // distance from rest to the contact plane, and least height of a bounce that counts [m]
  BandFollower band_;
  double nearest_ = std::numeric_limits<double>::quiet_NaN();  // position nearest to the contact since the turn towards it [m]
  double highest_ = 0, separated_ = 0;                         // height of the highest bounce [m], total time in separation [s]
  int bounces_ = 0;
};

struct OpeningFigures {
  static constexpr double unset = std::numeric_limits<double>::quiet_NaN();

  /// done: the contact opens, and the contact point stays in the band about its open position until the end of the time window.
  /// not_settled: at the end the contact is closed, or the contact point is outside the band. Otherwise the status of the run.
  Status status = Status::not_run;
  /// Time at which the contact opens for the last time [s]; NaN when the contact is closed at the end of the run.
  double release_time = unset;
  /// Time from which the contact point stays in the band about its open position [s]; NaN when outside at the end.
  double settling_time = unset;
  /// Largest excursion of the contact point beyond its open position, away from the contact [m]; 0 without one.
  double overshoot = unset;
  /// Largest distance of the contact point from its open position after OpeningBand::drives_end [m]; NaN when the run ends
  /// before drives_end, or closed.
  double residual_vibration = unset;
  int touches = 0;  ///< number of touches of the contact after the first opening
};

/// Returns the figures of the opening in a run that begins closed (ClosingOptions::begins_closed). For a run that did not reach
/// its end all figures but the status keep their defaults.
[[nodiscard]] OpeningFigures release_figures(const Trajectory& opening, const OpeningBand& band);

}  // namespace softland
