// Explicit Runge-Kutta steps of the pair 5(4) for the deviation of the modes of a beam from their free oscillation.
//
// The modes oscillate faster than the forces on them change: two periods of the fourth mode pass while the gap hardly moves. So
// a step contains the exact motion of every mode under the force at its start, kept constant. The Runge-Kutta method integrates
// only two unknowns P and R per mode, the effect of the change of the force. With omega the angular frequency of a mode, t the
// time from the start of the step, theta = omega t, q and v coordinate and velocity (q0, v0 and acceleration a at t = 0),
//
//   q = q0 + (a / omega^2) (1 - cos theta) + P cos theta + (v0 + R) sin theta / omega
//   v = (v0 + R) cos theta + (a / omega) sin theta - P omega sin theta
//   P' = -n sin theta / omega,  R' = n cos theta,  n = q'' + omega^2 q - (a + omega^2 q0)
//
// n is the change of the modal force since the start of the step, where P and R are 0.
//
// Source: integrating factor of Lawson 1967, here for the deviation from the equilibrium under the force at the start of the
// step (Certaine 1960). The pair: Dormand & Prince 1980, RK5(4)7M; the solution of fifth order is used, and the last stage is
// the first of the next step. Step size control: proportional-integral (Gustafsson 1991) with the exponents of Hairer & Wanner
// 1996, IV.2. The error of a step is the root mean square, over the unknowns, of the embedded estimate over the absolute
// tolerances. An estimate that is not a number rejects the step. Unknowns that are not modes, such as gas pressures, are
// integrated by the pair alone. The phase of the fastest mode advances by two radians per step at the most.
//
// The last two stages, which are at the same time, show how stiff the equations are: stiffness is the ratio of the difference
// of their slopes to the difference of their states (Hairer & Wanner 1996, IV.2).
//
// Compared with the same pair for the untransformed equations, the simulation of a closing at a tolerance of 1e-6 needs 2100
// instead of 4200 evaluations of the right-hand side. The error of the highest rebound is 3e-7 instead of 2e-4.
#pragma once

#include <array>

#include "integrators/phase.h"
#include "integrators/stepper.h"

namespace softland {

class Lawson final : public Stepper {
 public:
  explicit Lawson(const OdeSystem& system);
  bool restart(double t, const double* y, const double* rates, const std::vector<double>& absolute, double first_step,
               double max_step) override;
  bool step(double t_stop) override;
  [[nodiscard]] double time() const override { return t_; }
  [[nodiscard]] const double* state() const override { return y_.data(); }
  [[nodiscard]] const double* rates() override { return rates_.data(); }
  [[nodiscard]] std::string message() const override { return message_; }
  [[nodiscard]] double stiffness() const override;

 private:
  static constexpr std::size_t stages = 7;
  using Modal = std::vector<double>;  // one value per mode, padded to a multiple of the number of SIMD lanes

  struct Stage {
    Modal q, v;  // P' and R', the time derivatives of the two unknowns of each mode, at the stage
    // cos theta, sin theta and (1 - cos theta) / omega^2, with theta the phase of the mode from the start of the step to the
    // stage
    Modal cosine, sine, slack;
    std::vector<double> rest;  // time derivatives of the unknowns that are not modes
  };

  void turn_to_nodes(double h);
  template <std::size_t S>
  void evaluate(double t, double h);
  [[nodiscard]] double squared_error(double h) const;

  const OdeSystem& system_;
  std::size_t modes_, rest_;
  Modal omega_, inverse_;
  double fastest_ = 0;
  std::vector<double> y_, trial_, rates_, next_rates_, weight_;
  Modal q_, v_, a_;  // coordinate, velocity and acceleration of each mode at the start of the step
  Modal q_weight_, v_weight_;
  std::array<Stage, stages> k_;
  double turned_ = 0;  // step length for which cosine, sine and slack of all stages in k_ were computed [s]
  double t_ = 0, h_ = 0, max_step_ = 0;
  float last_error_ = 0;  // binary logarithm of the error estimate of the last step
  bool first_ = true;
  std::string message_;
};

}  // namespace softland
