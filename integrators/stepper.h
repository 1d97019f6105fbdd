// Interface of the methods that integrate ordinary differential equations from one discontinuity to the next.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "integrators/integrator.h"

namespace softland {

/// Equations of motion for the state y = (q, v, z) of dimension n: coordinates q and velocities v of the modes, with q' = v and
/// v' = -frequency^2 q + ..., and further unknowns z, such as gas pressures. Only the implicit methods need the Jacobian of y'
/// (column-major n x n).
struct OdeSystem {
  std::size_t size = 0;
  std::vector<double> frequencies = {};  ///< angular frequencies of the modes [rad/s]
  /// Writes v' and z', the time derivatives of v and z at the state y = (q, v, z), to `rates`.
  std::function<void(double t, const double* y, double* rates)> rates;
  std::function<void(double t, const double* y, double* jacobian)> jacobian;
  /// Sizes of a Jacobian in the shape of an arrow (integrators/arrow.h): the first `core` unknowns couple with all, the others
  /// form blocks of `block` unknowns that couple with the first `core` only. Both are 0 for a dense Jacobian.
  std::size_t core = 0, block = 0;
};

class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Restarts the integration at time t and state y, after a discontinuity. `rates` are (v', z') just after it, `absolute` the
  /// absolute tolerances of the unknowns, `first_step` a suggested length of the first step [s], `max_step` the largest [s].
  /// Returns false on failure; message() gives the reason.
  virtual bool restart(double t, const double* y, const double* rates, const std::vector<double>& absolute, double first_step,
                       double max_step) = 0;
  /// Makes one integration step, never beyond t_stop. Returns false when the step failed; message() gives the reason.
  virtual bool step(double t_stop) = 0;
  [[nodiscard]] virtual double time() const = 0;
  [[nodiscard]] virtual const double* state() const = 0;
  /// Returns the rates (v', z') of the state (q, v, z) at time(), from the last evaluation of the right-hand side.
  [[nodiscard]] virtual const double* rates() = 0;
  [[nodiscard]] virtual std::string message() const = 0;
  /// Returns the stiffness: the length of the last step over the time constant of the fastest decaying part of the solution; 0
  /// if the method does not compute it. Stability instead of the tolerance limits the steps of an explicit method if the
  /// stiffness is above about 3.
  [[nodiscard]] virtual double stiffness() const { return 0; }
};

/// Makes a stepper that keeps a reference to the system. `tolerance` is the relative tolerance from which the caller derives
/// the absolute tolerances of restart(); only esdirk uses it, to choose how its iterations start. Throws std::logic_error
/// for Integrator::automatic.
[[nodiscard]] std::unique_ptr<Stepper> make_stepper(Integrator integrator, const OdeSystem& system, double tolerance);

}  // namespace softland
