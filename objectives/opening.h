// Figures of an opening: how a closed switch lets go, and how long it swings once it has. Taken at the contact point, like those
// of a closing.
#pragma once

#include <limits>

#include "integrators/quintic.h"
#include "model/trajectory.h"
#include "objectives/rebounds.h"

namespace softland {

struct OpeningBand {
  double open_position = 0;  ///< of the contact point at rest under the open drives [m]
  double width = 0;          ///< the switch is open for good once it stays this near [m]
  double drives_end = 0;     ///< from when on the drives stand at their open levels [s]
};

/// How the contact point comes to rest in a band.
struct BandFigures {
  double settled_from = std::numeric_limits<double>::quiet_NaN();  ///< from when on it stays in the band [s]; NaN: it does not
  double below = 0, above = 0;  ///< furthest from the open position, away from the contact and towards it [m]; 0 if never
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
  double open_position =
      std::numeric_limits<double>::quiet_NaN();  ///< the contact point rests here under the levels that follow [m]; NaN: nowhere
};

/// How a closed switch opens on a command. Times count from the command; NaN throughout where it is closed at the end.
struct OpeningOnCommand {
  double command = std::numeric_limits<double>::quiet_NaN();        ///< [s], from t = 0
  double opening_time = std::numeric_limits<double>::quiet_NaN();   ///< to the last break of the contact [s]
  double settling_time = std::numeric_limits<double>::quiet_NaN();  ///< from when on it stays at rest, within settled_band [s]
  double overshoot = std::numeric_limits<double>::quiet_NaN();  ///< furthest beyond the open position, away from the contact [m]
  double least_gap = std::numeric_limits<double>::quiet_NaN();  ///< smallest separation on its way back [m]; the last, if none
  double highest_bounce = std::numeric_limits<double>::quiet_NaN();  ///< [m]; 0 where there is none
  double separated = 0;                                              ///< time in separations until the last break [s]
  int bounces = 0;  ///< separations above the significant rebound that end in a touch; meaningless where it is closed
};

/// Of the contact gap: the contact has come to rest where it stays so near its open position.
inline constexpr double settled_band = 0.02;

/// Finds them while a run goes on.
class CommandedOpening {
 public:
  /// Lengths in m.
  CommandedOpening(const OpeningCommand& command, double contact_gap, double significant_rebound);
  /// Takes the motion between two knots after the command.
  void follow(const TrajectoryPoint& a, const TrajectoryPoint& b);
  /// Takes a separation that ended in a touch after the command.
  void bounce(const Rebound& rebound);
  /// Of the run, once it has ended at its last knot, with the contact open since the begin of `under_way`, or closed.
  [[nodiscard]] OpeningOnCommand figures(const std::optional<Rebound>& under_way, const TrajectoryPoint& last) const;

 private:
  OpeningCommand command_;
  double contact_gap_, significant_;  // [m]
  BandFollower band_;
  double nearest_ = std::numeric_limits<double>::quiet_NaN();  // position on its way back [m]
  double highest_ = 0, separated_ = 0;                         // [m], [s]
  int bounces_ = 0;
};

struct OpeningFigures {
  static constexpr double unset = std::numeric_limits<double>::quiet_NaN();

  /// done: it opens, and stays in the band until the end of the window. not_settled: it is closed at the end, or outside the
  /// band. Else that of the run.
  Status status = Status::not_run;
  double release_time = unset;   ///< the contact point leaves the contact for good [s]; NaN while it is closed at the end
  double settling_time = unset;  ///< from when on it stays in the band [s]; NaN where it does not
  double overshoot = unset;      ///< furthest beyond its open position, away from the contact [m]; 0 if never
  double residual_vibration =
      unset;        ///< largest distance from the open position once the drives stand [m]; NaN before that, or while closed
  int touches = 0;  ///< of the contact after it has first left it
};

/// Of an opening (ClosingOptions::begins_closed). Of a run that did not come to its end the status alone.
[[nodiscard]] OpeningFigures release_figures(const Trajectory& opening, const OpeningBand& band);

}  // namespace softland
