// A user's own objective: a class outside softland that computes a value of a closing. A search minimises this value.
//
// A search uses an own objective like a target: its value F takes the place of the target's figure in the cost (cost.h). If
// lands_first() is true, the search first minimises the cost of `bounce` until a closing has no significant rebound, and then
// F; otherwise the search minimises F from its first evaluation on. F has no derivative: methods with a gradient use finite
// differences.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "objectives/metrics.h"

namespace softland {

/// Base class of own objectives. value() and values() are called from several threads at once and must not change shared data;
/// equal closings must give equal values. When value() throws for a candidate, the search treats this candidate as infeasible,
/// and stores the first message in OptimizerResult::first_exception. An exception for the plain step, or during the
/// verification of a result, is passed on to the caller of the search.
class OwnObjective {
 public:
  OwnObjective() = default;
  OwnObjective(const OwnObjective&) = default;
  OwnObjective& operator=(const OwnObjective&) = default;
  virtual ~OwnObjective() = default;

  /// Returns the name of the own objective, for messages and results.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Returns the value F of a closing that a search minimises. F must be >= 0, and should be about 1 for the plain step; F is
  /// divided by its value for the plain step if that value is below 0.01 or above 100. value() is called only for closings that
  /// reach contact and could be simulated to their end. NaN makes the candidate infeasible. A value below 0 causes
  /// InvalidInput, and so does a value of the plain step that is not finite.
  ///
  /// `closing` is in SI units. A figure that is not known is NaN: permanent_contact_time when the contact does not settle;
  /// static_deflection, overshoot and open_settling_time always; landing_excess outside a search on the nominal device;
  /// hold_force, capacitance, peak_voltage and peak_slew in a search under process variation. `step` holds the figures of the
  /// plain step to the same hold levels, on the nominal device. If the plain step does not reach contact, `step` holds
  /// estimates from the contact gap, the first mode and the stiffness of this switch, and NaN for all other figures.
  [[nodiscard]] virtual double value(const Metrics& closing, const Metrics& step) const = 0;
  /// Writes the values F of the closings of many devices into `values`, one per closing. A search under process variation calls
  /// values() once per candidate. This default calls value() for each closing.
  virtual void values(std::span<const Metrics> closings, const Metrics& step, std::span<double> values) const {
    for (std::size_t k = 0; k < closings.size(); ++k) values[k] = value(closings[k], step);
  }
  /// Returns true when a search first seeks a closing without a significant rebound. If false, every closing that reaches
  /// contact and stays closed costs F / (1 + F), F being value(), with or without rebounds, and the search seeks a lower F than
  /// that of the plain voltage step.
  [[nodiscard]] virtual bool lands_first() const { return true; }
};

}  // namespace softland
