// A user's own objective: a class from outside softland that scores a closing.
//
// A search uses it like a target with a cost of its own: its value F stands where the target's own figure would stand in the
// cost (cost.h). The search is led to a closing without a significant rebound first, and from there by F; or by F from its
// first evaluation on, as lands_first() says. F has no derivative: methods with a gradient take differences.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "objectives/metrics.h"

namespace softland {

/// Base class of own objectives. Both functions are called from several threads at once and must not change shared data; equal
/// closings must give equal values. Where value() throws for a candidate, the search takes it for infeasible, and keeps the
/// first message in OptimizerResult::first_exception. An exception for the plain step, or while a winner is verified, passes
/// through.
class OwnObjective {
 public:
  OwnObjective() = default;
  OwnObjective(const OwnObjective&) = default;
  OwnObjective& operator=(const OwnObjective&) = default;
  virtual ~OwnObjective() = default;

  /// Returns the name in messages and results.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Returns F, which is minimised. F is >= 0, and best about 1 for the plain step, beside whose figures it stands in the cost;
  /// a value of the step below 0.01 or above 100 becomes the unit of F. Only closings that touch, and could be followed to
  /// their end, are passed. NaN makes the point infeasible. A value below 0 is InvalidInput, and so is one of the plain step
  /// that is not finite.
  ///
  /// `closing` is in SI units. NaN stands for what is not known: permanent_contact_time where the contact does not settle; what
  /// no search measures (static_deflection, overshoot, open_settling_time); landing_excess outside a search on the nominal
  /// device; and over devices hold_force, capacitance, peak_voltage and peak_slew.
  /// `step` holds the same figures of the plain step to the same hold levels, on the nominal device. Where the step does not
  /// touch, it holds estimates for a closing of this switch, and NaN.
  [[nodiscard]] virtual double value(const Metrics& closing, const Metrics& step) const = 0;
  /// Writes F of the closings of many devices into `values`, one per closing. A search over devices calls it once per
  /// candidate. The default calls value() for each.
  virtual void values(std::span<const Metrics> closings, const Metrics& step, std::span<double> values) const {
    for (std::size_t k = 0; k < closings.size(); ++k) values[k] = value(closings[k], step);
  }
  /// True when the search is first for a landing without a significant rebound. Otherwise what touches and stays costs F / (1 +
  /// F), however it bounces, and the goal is met by what is better than the plain step.
  [[nodiscard]] virtual bool lands_first() const { return true; }
};

}  // namespace softland
