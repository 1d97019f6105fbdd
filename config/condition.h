// Reads from text what a search under process variation minimises or requires: a statistic ("cvar:0.9"), or a condition on a
// figure of merit ("permanent_contact_time < 60 us").
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "objectives/figures.h"
#include "sampling/risk.h"

namespace softland {

enum class Comparison { below, at_most, equal, at_least, above };

/// A condition on a figure of merit of one closing, such as "t_p < 60 us".
struct Condition {
  Figure figure;
  Comparison comparison = Comparison::below;
  double limit = 0;      ///< limit of the figure [its SI unit; if of_step, multiples of its value under the plain voltage step]
  std::string text;      ///< the condition as the user wrote it
  bool of_step = false;  ///< true if the limit is in multiples of the figure under a plain voltage step

  /// Returns the violation of the condition by a figure's value, relative to the limit (absolute if the limit is 0); 0 or less
  /// if the condition holds. Returns infinity for a value that is not finite, which a failed closing has.
  [[nodiscard]] double violation(double value) const;
  [[nodiscard]] bool holds(double value) const;
};

/// Reads a condition such as "t_p < 60 us", or one whose limit is relative to the plain voltage step, "t_i < 3 step". Throws
/// InvalidInput whose message states the rule that the text breaks.
[[nodiscard]] Condition parse_condition(std::string_view text, std::span<const Figure> figures);

/// Returns the condition with an absolute limit. A limit relative to the plain voltage step is multiplied by `of_step`, the
/// figure under this step. Throws InvalidInput if the limit is relative and `of_step` is 0 or not finite.
[[nodiscard]] Condition beside_step(Condition condition, double of_step);

/// The statistic over simulated devices (process variation) that a search minimises.
struct RobustMeasure {
  Risk risk;                       ///< statistic over the devices' costs that a search minimises; unused if `yield` is set
  std::optional<Condition> yield;  ///< condition; a search maximises the share of devices that fulfil it
  std::string text;                ///< the statistic as the user wrote it
};

/// Reads the statistic that a search minimises: cvar:LEVEL, quantile:LEVEL, mean+Ksigma, worst, yield:CONDITION, or yield,
/// whose condition is no significant rebound. Throws InvalidInput whose message states the rule that the text breaks.
[[nodiscard]] RobustMeasure parse_robust_measure(std::string_view text, std::span<const Figure> figures);

}  // namespace softland
