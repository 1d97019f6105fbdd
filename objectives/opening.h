// Figures of an opening: how a closed switch releases, and how long it vibrates afterwards. They are taken at the contact
// point, like those of a closing.
#pragma once

#include <limits>

#include "integrators/quintic.h"
#include "model/trajectory.h"
#include "objectives/rebounds.h"

namespace softland {

struct OpeningBand {
  double open_position = 0;  ///< position of the contact point at rest under the open drives [m]
  double width = 0;          ///< half-width of the band [m]: the switch is open for good once it stays this near
  double drives_end = 0;     ///< time from which the drives stand at their open levels [s]
};

/// The settling of the contact point in a band.
struct BandFigures {
  /// Time from which it stays in the band [s]; NaN where it does not.
  double settled_from = std::numeric_limits<double>::quiet_NaN();
  double below = 0, above = 0;  ///< largest excursion from the open position, away from and towards the contact [m]; 0 if none
  double residual = std::numeric_limits<double>::quiet_NaN();  ///< OpeningFigures::residual_vibration
};

/// Follows the distance from the open position from one turn to the next. Between knots the motion is the quintic through them.
class BandFollower {
 public:
  explicit BandFollower(const OpeningBand& band) : band_(band) {}
  /// Takes the motion between two knots.
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

/// A command to open, while a run goes on.
struct OpeningCommand {
  double time = std::numeric_limits<double>::infinity();  ///< [s]
  /// Rest position of the contact point under the levels that follow [m]; NaN where it has none.
  double open_position = std::numeric_limits<double>::quiet_NaN();
};

/// The opening of a closed switch on a command. Times count from the command; NaN throughout where it is closed at the end.
struct OpeningOnCommand {
  double command = std::numeric_limits<double>::quiet_NaN();       ///< time of the command from t = 0 [s]
  double opening_time = std::numeric_limits<double>::quiet_NaN();  ///< time to the last break of the contact [s]
  /// Time from which the contact point stays at rest, within settled_band [s].
  double settling_time = std::numeric_limits<double>::quiet_NaN();
  /// Largest excursion beyond the open position, away from the contact [m].
  double overshoot = std::numeric_limits<double>::quiet_NaN();
  double least_gap = std::numeric_limits<double>::quiet_NaN();  ///< smallest separation on the way back, or the last [m]
  /// Highest separation that ends in a touch [m]; 0 without a bounce.
  double highest_bounce = std::numeric_limits<double>::quiet_NaN();
  double separated = 0;  ///< time in separations until the last break [s]
  /// Number of separations above the significant rebound that end in a touch; meaningless where the contact is closed.
  int bounces = 0;
};

/// The contact has come to rest where it stays within this share of the contact gap of its open position.
inline constexpr double settled_band = 0.02;

/// Finds the figures of an opening on a command while a run goes on.
class CommandedOpening {
 public:
  /// Lengths are in m.
  CommandedOpening(const OpeningCommand& command, double contact_gap, double significant_rebound);
  /// Takes the motion between two knots after the command.
  void follow(const TrajectoryPoint& a, const TrajectoryPoint& b);
  /// Takes a separation that ended in a touch after the command.
  void bounce(const Rebound& rebound);
  /// Returns the figures once the run has ended at its last knot. `under_way`: the separation in which the contact stands open;
  /// none where it is closed.
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

  /// done: the contact opens, and stays in the band until the end of the window. not_settled: it is closed at the end, or
  /// outside the band. Otherwise the status of the run.
  Status status = Status::not_run;
  /// Time at which the contact point leaves the contact for good [s]; NaN while it is closed at the end.
  double release_time = unset;
  double settling_time = unset;  ///< time from which it stays in the band [s]; NaN where it does not
  double overshoot = unset;      ///< largest excursion beyond its open position, away from the contact [m]; 0 if none
  /// Largest distance from the open position once the drives stand [m]; NaN before that, or while closed.
  double residual_vibration = unset;
  int touches = 0;  ///< number of touches of the contact after it has first left it
};

/// Returns the figures of an opening (ClosingOptions::begins_closed). A run that did not come to its end has the status alone.
[[nodiscard]] OpeningFigures release_figures(const Trajectory& opening, const OpeningBand& band);

}  // namespace softland
