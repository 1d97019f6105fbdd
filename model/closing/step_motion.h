// Motion of the switch within one step of the integrator: the motion of the contact point, divided into pieces so short that a
// quintic describes each, and all modal coordinates at single times.
//
// Explicit methods take steps of up to two radians of the fastest mode. Within such a step the motion is the free motion of the
// modes under the force at the start, plus a quintic for the change of the force (integrators/modal_motion.h). Longer steps
// come from an implicit method; one Hermite polynomial covers each such step.
#pragma once

#include <vector>

#include "integrators/modal_motion.h"
#include "integrators/quintic.h"
#include "model/closing/knot.h"
#include "model/switch.h"
#include "model/trajectory.h"

namespace softland {

class StepMotion {
 public:
  /// Describes the motion of contact number `contact`. A step is divided into pieces so short that the error of a quintic is at
  /// most `tolerance` (the relative tolerance of the integrator) or 1e-5, relative to the amplitude of the fastest mode.
  StepMotion(const Switch& model, double tolerance, std::size_t contact = 0);

  /// Sets the step between two points of the motion (knots); `end` is the contact point at the end of the step. Keeps
  /// references to the knots. `accurate_rates` is true when the accelerations at the knots may be used for interpolation; those
  /// of an implicit method may contain small errors multiplied by a large stiffness.
  void set(const Knot& begin, const Knot& end_knot, const TrajectoryPoint& end, bool accurate_rates);

  [[nodiscard]] bool moves_by_modes() const { return moves_by_modes_; }
  [[nodiscard]] int pieces() const { return pieces_; }
  [[nodiscard]] double begin_time() const { return begin_->time; }
  [[nodiscard]] double length() const { return end_->time - begin_->time; }
  /// Returns the motion of the contact point at the end of piece k of the step, 1 <= k < pieces().
  [[nodiscard]] const ModalMotion::Sample& knot(int k) { return motion().knot(k); }
  /// Returns the motion of the contact point at a time in the step [s]. Call the function only if moves_by_modes() is true: the
  /// fastest mode's phase then advances by at most two radians in the step.
  [[nodiscard]] ModalMotion::Sample at(double time) { return motion().at(time - begin_->time); }

  /// Returns modal coordinates, velocities and film pressures halfway through the step by Hermite interpolation; valid until
  /// the next call of halfway() or state_at().
  const std::vector<double>& halfway();
  /// Returns modal coordinates and velocities after a share of the step: the free motion of the modes under the force at the
  /// start, plus a quintic. `share` is from 0 to 1. Call the function only if moves_by_modes() is true, and for a switch
  /// without a compressible film.
  const std::vector<double>& state_at(double share);

 private:
  const ModalMotion& motion();

  std::size_t modes_, film_;
  double fastest_;             // angular frequency of the fastest mode [rad/s]
  double knot_phase_;          // largest advance of the fastest mode's phase in a piece of the step [rad]
  std::vector<double> omega_;  // angular frequencies of the modes, padded to a multiple of the SIMD lanes [rad/s]
  ModalMotion motion_;
  bool motion_known_ = false;
  const Knot* begin_ = nullptr;
  const Knot* end_ = nullptr;
  TrajectoryPoint tip_end_;
  bool accurate_rates_ = true, moves_by_modes_ = true;
  int pieces_ = 1;
  std::vector<double> between_;
};

/// Motion of the contact point in a piece of an integration step, a quintic in time.
class TipMotion : public Quintic {
 public:
  TipMotion(StepMotion& step, const TrajectoryPoint& from, const TrajectoryPoint& to)
      : Quintic(from.time, from.position, from.velocity, from.acceleration, to.time, to.position, to.velocity, to.acceleration),
        step_(step) {}
  [[nodiscard]] double position(double t) const { return step_.moves_by_modes() ? step_.at(t).position : Quintic::position(t); }
  [[nodiscard]] double velocity(double t) const { return step_.moves_by_modes() ? step_.at(t).velocity : Quintic::velocity(t); }
  [[nodiscard]] double acceleration(double t) const {
    return step_.moves_by_modes() ? step_.at(t).acceleration : Quintic::acceleration(t);
  }
  /// Returns the time in this piece of the step at which the contact point turns back (its velocity changes sign) [s].
  [[nodiscard]] double turn() const {
    return bracketed_zero([&](double t) { return velocity(t); }, begin(), end());
  }

 private:
  StepMotion& step_;
};

}  // namespace softland
