// Figures of an opening: how a closed switch opens, and how long it vibrates afterwards. They are taken at the contact point,
// like those of a closing.
#pragma once

#include <limits>

#include "integrators/quintic.h"
#include "model/trajectory.h"
#include "objectives/rebounds.h"

namespace softland {

struct OpeningBand {
  double open_position = 0;  ///< position of the contact point at rest under the open drives [m]
  double width = 0;       ///< half-width of the band [m]: the switch is open for good once its contact point stays in this band
  double drives_end = 0;  ///< time from which the drives are at their open levels [s]
};

/// The settling of the contact point in a band about its open position.
struct BandFigures {
  /// Time from which the contact point stays in the band [s]; NaN when it does not.
  double settled_from = std::numeric_limits<double>::quiet_NaN();
  double below = 0, above = 0;  ///< largest excursion from the open position, away from and towards the contact [m]; 0 if none
  double residual = std::numeric_limits<double>::quiet_NaN();  ///< OpeningFigures::residual_vibration
};

/// Computes the figures of a band from the distance to the open position, turning point by turning point. Between knots the
/// motion is the quintic through them.
class BandFollower {
 public:
  explicit BandFollower(const OpeningBand& band) : band_(band) {}
  /// Adds the motion between two knots.
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

/// A command to open during a run.
struct OpeningCommand {
  double time = std::numeric_limits<double>::infinity();  ///< time of the command [s]
  /// Rest position of the contact point under the levels after the command [m]; NaN when it has none.
  double open_position = std::numeric_limits<double>::quiet_NaN();
};

/// The opening of a closed switch on a command. Times count from the command; all are NaN when the contact is closed at the
/// end.
struct OpeningOnCommand {
  double command = std::numeric_limits<double>::quiet_NaN();       ///< time of the command from t = 0 [s]
  double opening_time = std::numeric_limits<double>::quiet_NaN();  ///< time to the last break of the contact [s]
  /// Time from which the contact point stays at rest, within settled_band [s].
  double settling_time = std::numeric_limits<double>::quiet_NaN();
  /// Largest excursion beyond the open position, away from the contact [m].
  double overshoot = std::numeric_limits<double>::quiet_NaN();
  /// Smallest separation after the turn back towards the contact, or the last separation [m].
  double least_gap = std::numeric_limits<double>::quiet_NaN();
  /// Highest separation that ends in a touch [m]; 0 without a bounce.
  double highest_bounce = std::numeric_limits<double>::quiet_NaN();
  double separated = 0;  ///< time in separations until the last break [s]
  /// Number of separations above the significant rebound that end in a touch; meaningless when the contact is closed at the
  /// end.
  int bounces = 0;
};

/// The contact is at rest when it stays within this share of the contact gap of its open position.
inline constexpr double settled_band = 0.02;

/// Computes the figures of an opening on a command during a run.
class CommandedOpening {
 public:
  /// Lengths are in m.
  CommandedOpening(const OpeningCommand& command, double contact_gap, double significant_rebound);
  /// Adds the motion between two knots after the command.
  void follow(const TrajectoryPoint& a, const TrajectoryPoint& b);
  /// Adds a separation that ended in a touch after the command.
  void bounce(const Rebound& rebound);
  /// Returns the figures after the run has ended at its last knot. `under_way` is the separation that has not ended; none when
  /// the contact is closed.
  [[nodiscard]] OpeningOnCommand figures(const std::optional<Rebound>& under_way, const TrajectoryPoint& last) const;

 private:
  OpeningCommand command_;
  double contact_gap_, significant_;  // [m]
  BandFollower band_;
  double nearest_ = std::numeric_limits<double>::quiet_NaN();  // smallest position on the way back [m]
  double highest_ = 0, separated_ = 0;                         // [m], [s]
  int bounces_ = 0;
};

struct OpeningFigures {
  static constexpr double unset = std::numeric_limits<double>::quiet_NaN();

  /// done: the contact opens, and stays in the band until the end of the window. not_settled: at the end the contact is closed,
  /// or outside the band. Otherwise the status of the run.
  Status status = Status::not_run;
  /// Time at which the contact point leaves the contact for good [s]; NaN when the contact is closed at the end.
  double release_time = unset;
  double settling_time = unset;  ///< time from which the contact point stays in the band [s]; NaN when it does not
  double overshoot = unset;      ///< largest excursion beyond the open position, away from the contact [m]; 0 if none
  /// Largest distance from the open position after drives_end [m]; NaN when the run ends before, or with a closed contact.
  double residual_vibration = unset;
  int touches = 0;  ///< number of touches of the contact after the first opening
};

/// Returns the figures of an opening (ClosingOptions::begins_closed). A run that did not reach its end has a status only.
[[nodiscard]] OpeningFigures release_figures(const Trajectory& opening, const OpeningBand& band);

}  // namespace softland
