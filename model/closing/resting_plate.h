// A rigid plate on a rigid contact: impacts, and rest until the drives pull it off.
#pragma once

#include <vector>

#include "model/closing/drive_course.h"
#include "model/closing/equations.h"
#include "model/contact/rigid.h"

namespace softland {

class RestingPlate {
 public:
  /// Keeps references. Without a rigid contact nothing may be asked of it but force().
  RestingPlate(const Switch& model, DriveCourse& drives, ClosingEquations& equations);

  struct Impact {
    double energy = 0;  ///< kinetic, before [J]
    double lost = 0;    ///< [J]
    bool rests = false;
  };
  /// The plate has arrived at the plane of first touch: puts it there with the velocity that it rebounds with, or at rest where
  /// the rebound would be too low.
  Impact strike(Knot& here);

  /// Stays where it is from this knot, whose rates are known, to the end of the stretch at most.
  void begin(Knot& here, double stretch_end);
  struct Stay {
    double until = 0;     ///< [s]
    bool leaves = false;  ///< the drives pull it off then
  };
  /// Goes on for a while, and no longer than the plate is pressed on.
  Stay stay(const Knot& here, double stretch_end);
  /// On the contact while it rests [N].
  [[nodiscard]] double force() const { return force_ > 0 ? force_ : 0; }
  /// Force with which the plate would press on the contact at `here` under the drives of another time [N]; negative: pull.
  [[nodiscard]] double press(const Knot& here, double t);

 private:
  const Switch& model_;
  DriveCourse& drives_;
  ClosingEquations& equations_;
  double force_ = 0;  // pressing at the last knot [N]
  double look_ = 0;   // how long it stays at a time, at the most [s]
  std::vector<double> rates_;
};

}  // namespace softland
