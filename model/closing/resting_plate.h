// A rigid plate on a rigid contact: impacts, and rest until the drives pull the plate off.
#pragma once

#include <vector>

#include "model/closing/drive_course.h"
#include "model/closing/equations.h"
#include "model/contact/rigid.h"

namespace softland {

class RestingPlate {
 public:
  /// Keeps references to its arguments. When the switch has no rigid contact, call only force().
  RestingPlate(const Switch& model, DriveCourse& drives, ClosingEquations& equations);

  struct Impact {
    double energy = 0;  ///< kinetic energy of the plate before the impact [J]
    double lost = 0;    ///< energy of the plate lost in the impact [J]
    bool rests = false;
  };
  /// Computes the impact of a plate that reaches the contact plane. Afterwards the plate is on the contact plane with its
  /// rebound velocity, or at rest when the rebound would be lower than RigidContact::rest_height.
  Impact strike(Knot& here);

  /// Begins a rest of the plate on its contact in the state `here`, whose accelerations must have been computed. The rest lasts
  /// at most until `stretch_end` [s], the next breakpoint of the drives.
  void begin(Knot& here, double stretch_end);
  struct Stay {
    double until = 0;     ///< end of this interval in which the plate rests [s]
    bool leaves = false;  ///< true when the drives pull the plate off at `until`
  };
  /// Continues the rest of the plate on its contact by one short interval. The interval ends early when the force changes sign
  /// and pulls the plate off.
  Stay stay(const Knot& here, double stretch_end);
  /// Returns the force with which the resting plate presses on its contact at the end of the last interval [N].
  [[nodiscard]] double force() const { return force_ > 0 ? force_ : 0; }
  /// Returns the force with which the plate at rest at `here` presses on the contact under the drives of time t [N]; negative
  /// when the drives pull the plate off.
  [[nodiscard]] double load(const Knot& here, double t);

 private:
  const Switch& model_;
  DriveCourse& drives_;
  ClosingEquations& equations_;
  double force_ = 0;  // force that presses the plate on the contact at the end of the last interval [N]
  double look_ = 0;   // longest time between two evaluations of the force on the resting plate [s]
  std::vector<double> rates_;
};

}  // namespace softland
