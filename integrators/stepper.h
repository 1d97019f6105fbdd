// Interface of the methods that integrate ordinary differential equations from one discontinuity to the next.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "integrators/integrator.h"

namespace softland {

/// A system y = (q, v, z) of dimension n: modes with q' = v, v' = -frequency^2 q + ..., and further unknowns z. Only the
/// implicit methods need the Jacobian of y' (column-major n x n).
struct OdeSystem {
  std::size_t size = 0;
  std::vector<double> frequencies = {};  ///< angular frequencies of the modes [rad/s]
  /// Writes the rates (v', z') of the state y = (q, v, z) to `rates`.
  std::function<void(double t, const double* y, double* rates)> rates;
  std::function<void(double t, const double* y, double* jacobian)> jacobian;
  /// Sizes of a Jacobian in the shape of an arrow; both 0 for a dense Jacobian. Beyond the first `core` unknowns the Jacobian
  /// has blocks of size `block` that couple with the first `core` unknowns only.
  std::size_t core = 0, block = 0;
};

class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Restarts the integration at (t, y), after a discontinuity; (v', z') is `rates` there. `absolute` are the absolute
  /// tolerances per unknown, `first_step` is a suggested length of the first step [s].
  virtual bool restart(double t, const double* y, const double* rates, const std::vector<double>& absolute, double first_step,
                       double max_step) = 0;
  /// Makes one integration step, never beyond t_stop. Returns false when the step failed; message() gives the reason.
  virtual bool step(double t_stop) = 0;
  [[nodiscard]] virtual double time() const = 0;
  [[nodiscard]] virtual const double* state() const = 0;
  /// Returns the rates (v', z') of the state (q, v, z) at time(), from the last evaluation of the right-hand side.
  [[nodiscard]] virtual const double* rates() = 0;
  [[nodiscard]] virtual std::string message() const = 0;
  /// Returns the stiffness: the last step's length over the time in which the fastest part of the solution decays; 0 if the
  /// method does not compute the stiffness. Stability instead of the tolerance limits the steps of an explicit method above a
  /// stiffness of about 3.
  [[nodiscard]] virtual double stiffness() const { return 0; }
};

/// Makes a stepper that keeps a reference to the system. `tolerance` is the relative tolerance from which the caller derives
/// the absolute tolerances of restart(); an implicit method chooses its predictor by this tolerance. Throws std::logic_error
/// for Integrator::automatic.
[[nodiscard]] std::unique_ptr<Stepper> make_stepper(Integrator integrator, const OdeSystem& system, double tolerance);

}  // namespace softland
