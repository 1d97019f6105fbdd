// A rigid plate on a rigid contact: impacts, and rest until the drives pull the plate off.
#pragma once

#include <vector>

#include "model/closing/drive_course.h"
#include "model/closing/equations.h"
#include "model/contact/rigid.h"

namespace softland {

class RestingPlate {
 public:
  /// Keeps references to its arguments. Without a rigid contact, force() is the only function that may be called.
  RestingPlate(const Switch& model, DriveCourse& drives, ClosingEquations& equations);

  struct Impact {
    double energy = 0;  ///< kinetic energy of the plate before the impact [J]
    double lost = 0;    ///< energy of the plate lost in the impact [J]
    bool rests = false;
  };
  /// Computes the impact of a plate that reaches the plane of first touch. Afterwards the plate is on the plane with its
  /// rebound velocity, or at rest when the rebound would be lower than RigidContact::rest_height.
  Impact strike(Knot& here);

  /// Begins a rest of the plate in this state, whose accelerations have been computed. The rest ends at `stretch_end`, the next
  /// breakpoint of the drives, at the latest.
  void begin(Knot& here, double stretch_end);
  struct Stay {
    double until = 0;     ///< end of this interval in which the plate rests [s]
    bool leaves = false;  ///< true when the drives pull the plate off at `until`
  };
  /// Continues the rest of the plate on its contact by one interval, which ends early when no force presses the plate on the
  /// contact any more.
  Stay stay(const Knot& here, double stretch_end);
  /// Returns the force of the plate on the contact while the plate rests [N].
  [[nodiscard]] double force() const { return force_ > 0 ? force_ : 0; }
  /// Returns the force with which the plate at rest at `here` presses on the contact under the drives of time t [N]; negative
  /// when the drives pull the plate off.
  [[nodiscard]] double load(const Knot& here, double t);

 private:
  const Switch& model_;
  DriveCourse& drives_;
  ClosingEquations& equations_;
  double force_ = 0;  // force that presses the plate on the contact at the end of the last interval [N]
  double look_ = 0;   // longest time between two evaluations of the drives while the plate rests [s]
  std::vector<double> rates_;
};

}  // namespace softland
