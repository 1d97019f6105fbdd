// One smooth stretch of an ordinary differential equation at a time, whatever the method.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "integrators/integrator.h"

namespace softland {

/// y = (q, v, z) of dimension n: modes with q' = v, v' = -frequency^2 q + ..., and what follows them. The Jacobian of y' is
/// needed by the implicit methods only (column-major n x n).
struct OdeSystem {
  std::size_t size = 0;
  std::vector<double> frequencies = {};  ///< of the modes [rad/s]
  /// (v', z').
  std::function<void(double t, const double* y, double* rates)> rates;
  std::function<void(double t, const double* y, double* jacobian)> jacobian;
  /// Above 0: beyond the first `core` unknowns the Jacobian has blocks of this size that couple with the core only.
  std::size_t core = 0, block = 0;
};

class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Starts a smooth stretch at (t, y), where (v', z') is `rates`. `absolute` are the absolute tolerances per unknown,
  /// `first_step` a suggestion [s].
  virtual bool restart(double t, const double* y, const double* rates, const std::vector<double>& absolute, double first_step,
                       double max_step) = 0;
  /// One step, never beyond t_stop. False: failed, see message().
  virtual bool step(double t_stop) = 0;
  [[nodiscard]] virtual double time() const = 0;
  [[nodiscard]] virtual const double* state() const = 0;
  /// (v', z') at time(); the last evaluation of the right-hand side was there.
  [[nodiscard]] virtual const double* rates() = 0;
  [[nodiscard]] virtual std::string message() const = 0;
  /// Of an explicit method that knows it: the last step's length over the time in which the fastest part of what it integrates
  /// decays. At its limit of stability, about 3, it is this and not the tolerance that keeps steps short. 0 where not known.
  [[nodiscard]] virtual double stiffness() const { return 0; }
};

/// Keeps a reference to the system. `tolerance`: relative, what the absolute ones of a restart come from; how a method begins a
/// step best depends on it. Throws std::logic_error for `automatic`.
[[nodiscard]] std::unique_ptr<Stepper> make_stepper(Integrator integrator, const OdeSystem& system, double tolerance);

}  // namespace softland
