// Explicit Runge-Kutta steps of the pair 5(4) for short vectors.
//
// The pair: Dormand & Prince 1980, RK5(4)7M; the fifth order is carried on, the last stage is the first of the next step. Step
// size control: proportional-integral (Gustafsson 1991) with the exponents of Hairer & Wanner 1996, IV.2. The error of a step is
// the root mean square, over the unknowns, of the embedded estimate over the absolute tolerances. An estimate that is not a
// number rejects the step.
//
// ARKODE has the same pair (Integrator::arkode_erk) and gives the same figures; on the few unknowns of a switch its vector kernel
// costs twice what the right-hand side does.
#pragma once

#include <array>

#include "model/stepper.h"

namespace softland::internal {

class DormandPrince final : public Stepper {
 public:
  explicit DormandPrince(const OdeSystem& system);
  bool restart(double t, const double* y, const std::vector<double>& absolute, double first_step, double max_step) override;
  bool step(double t_stop) override;
  [[nodiscard]] double time() const override { return t_; }
  [[nodiscard]] const double* state() const override { return y_.data(); }
  [[nodiscard]] std::string message() const override { return message_; }

 private:
  static constexpr std::size_t stages = 7;
  template <std::size_t Stage>
  void evaluate(double t, double h);
  [[nodiscard]] double error(double h) const;

  const OdeSystem& system_;
  std::size_t n_;
  std::vector<double> y_, trial_, weights_;
  std::array<std::vector<double>, stages> k_;
  double t_ = 0, h_ = 0, max_step_ = 0;
  double last_error_ = 0;
  bool first_ = true;
  std::string message_;
};

}  // namespace softland::internal
