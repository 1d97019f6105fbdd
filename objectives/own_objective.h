// A user's own objective: a class from outside softland that says what a closing is worth.
//
// A search goes by it as by a target with a cost of its own: F, its value, stands where the target's own figure would stand in
// the cost (cost.h). It is led to a closing without a significant rebound first, and from there by F; or by F from its first
// evaluation on, as lands_first() says. F has no derivative: methods with a gradient take differences.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "objectives/metrics.h"

namespace softland {

/// To be derived from. Both functions are called from several threads at once, and give the same for the same closings: they must
/// not change what they share. Where value() throws for a candidate, the search takes it for infeasible, and tells of the first
/// in OptimizerResult::first_exception; for the plain step, and where a winner is verified, it passes through.
class OwnObjective {
 public:
  OwnObjective() = default;
  OwnObjective(const OwnObjective&) = default;
  OwnObjective& operator=(const OwnObjective&) = default;
  virtual ~OwnObjective() = default;

  /// What messages and results call it.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// F, which is minimised: >= 0, and best about 1 for the plain step, beside whose figures it stands in the cost. Where it is
  /// below 0.01 or above 100 for the step, it is divided by that. It is asked of closings that touch, and could be followed to
  /// their end. NaN: the point is infeasible. A value below 0 is InvalidInput, and so is one of the plain step that is not
  /// finite.
  ///
  /// `closing`: in SI units, not known what is NaN: permanent_contact_time of what does not settle, what no search measures
  /// (static_deflection, overshoot, open_settling_time), landing_excess but in the search on the nominal device, and over devices
  /// hold_force, capacitance, peak_voltage and peak_slew.
  /// `step`: the same of the plain step to the same hold levels, on the nominal device. Where the step does not touch it holds
  /// what a closing of this switch would be like, and NaN.
  [[nodiscard]] virtual double value(const Metrics& closing, const Metrics& step) const = 0;
  /// F of the closings of many devices, as many as there are in `values`: asked once for a candidate, where a search is for
  /// devices. By default value() of each.
  virtual void values(std::span<const Metrics> closings, const Metrics& step, std::span<double> values) const {
    for (std::size_t k = 0; k < closings.size(); ++k) values[k] = value(closings[k], step);
  }
  /// Whether the search is for a landing without a significant rebound first. Where it is not, what touches and stays costs
  /// F / (1 + F), however it bounces, and the goal is met by what is better than the plain step.
  [[nodiscard]] virtual bool lands_first() const { return true; }
};

}  // namespace softland
