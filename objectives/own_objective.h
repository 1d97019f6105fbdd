// A user's own objective: a class outside softland that computes a value of a closing, which a search minimises.
//
// A search uses it like a target with a cost of its own: its value F takes the place of the target's own figure in the cost
// (cost.h). If lands_first() is true, the search first minimises the cost of `bounce` until a closing has no significant
// rebound, and then F; otherwise it minimises F from its first evaluation on. F has no derivative: methods with a gradient take
// differences.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "objectives/metrics.h"

namespace softland {

/// Base class of own objectives. Both functions are called from several threads at once and must not change shared data; equal
/// closings must give equal values. When value() throws for a candidate, the search treats this candidate as infeasible, and
/// keeps the first message in OptimizerResult::first_exception. An exception for the plain step, or during the verification of
/// a result, is passed on to the caller of the search.
class OwnObjective {
 public:
  OwnObjective() = default;
  OwnObjective(const OwnObjective&) = default;
  OwnObjective& operator=(const OwnObjective&) = default;
  virtual ~OwnObjective() = default;

  /// Returns the name for messages and results.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Returns F, which is minimised. F must be >= 0, and is best about 1 for the plain step; F is divided by its value for the
  /// plain step if this value is below 0.01 or above 100. value() is called only for closings that touch and could be simulated
  /// to their end. NaN makes the point infeasible. A value below 0 is InvalidInput, and so is a value of the plain step that is
  /// not finite.
  ///
  /// `closing` is in SI units. A figure that is not known is NaN: permanent_contact_time when the contact does not settle;
  /// static_deflection, overshoot and open_settling_time always; landing_excess outside a search on the nominal device; and
  /// over devices hold_force, capacitance, peak_voltage and peak_slew. `step` holds the same figures of the plain step to the
  /// same hold levels, on the nominal device. Where the step does not touch, it holds estimates for a closing of this switch,
  /// and NaN.
  [[nodiscard]] virtual double value(const Metrics& closing, const Metrics& step) const = 0;
  /// Writes F of the closings of many devices into `values`, one per closing. A search over devices calls values() once per
  /// candidate. The default calls value() for each closing.
  virtual void values(std::span<const Metrics> closings, const Metrics& step, std::span<double> values) const {
    for (std::size_t k = 0; k < closings.size(); ++k) values[k] = value(closings[k], step);
  }
  /// Returns true when a search first seeks a closing without a significant rebound. Otherwise every closing that touches and
  /// stays closed costs F / (1 + F), whatever its rebounds, and the goal is a lower F than that of the plain step.
  [[nodiscard]] virtual bool lands_first() const { return true; }
};

}  // namespace softland
