// A rigid plate on a rigid contact: impacts, and rest until the drives pull it off.
#pragma once

#include <vector>

#include "model/closing/drive_course.h"
#include "model/closing/equations.h"
#include "model/contact/rigid.h"

namespace softland {

class RestingPlate {
 public:
  /// Keeps references to its arguments. Without a rigid contact only force() may be called.
  RestingPlate(const Switch& model, DriveCourse& drives, ClosingEquations& equations);

  struct Impact {
    double energy = 0;  ///< kinetic energy before the impact [J]
    double lost = 0;    ///< energy lost in the impact [J]
    bool rests = false;
  };
  /// Computes the impact of a plate that reaches the plane of first touch. Afterwards the plate is on the plane with its
  /// rebound velocity, or at rest when the rebound would be lower than RigidContact::rest_height.
  Impact strike(Knot& here);

  /// Begins a rest of the plate at this knot, whose rates have been computed. The rest ends at `stretch_end` at the latest.
  void begin(Knot& here, double stretch_end);
  struct Stay {
    double until = 0;     ///< end of this interval of the rest [s]
    bool leaves = false;  ///< true when the drives pull the plate off at `until`
  };
  /// Continues the rest of the plate by one interval, which ends early when no force presses the plate on the contact any more.
  Stay stay(const Knot& here, double stretch_end);
  /// Returns the force on the contact while the plate rests [N].
  [[nodiscard]] double force() const { return force_ > 0 ? force_ : 0; }
  /// Returns the force with which the plate at rest at `here` presses on the contact under the drives of time t [N]; negative
  /// when the drives pull the plate off.
  [[nodiscard]] double load(const Knot& here, double t);

 private:
  const Switch& model_;
  DriveCourse& drives_;
  ClosingEquations& equations_;
  double force_ = 0;  // pressing force at the last knot [N]
  double look_ = 0;   // longest time between two evaluations of the drives while the plate rests [s]
  std::vector<double> rates_;
};

}  // namespace softland
