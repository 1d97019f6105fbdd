// The requests of a robust search, from text: a measure of risk ("cvar:0.9"), or a condition on a figure of merit
// ("permanent_contact_time < 60 us").
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

/// A condition on a figure of one closing.
struct Criterion {
  Figure figure;
  Comparison comparison = Comparison::below;
  double limit = 0;      ///< limit [SI unit of the figure, or that figure of the plain step]
  std::string text;      ///< the text as given
  bool of_step = false;  ///< true when the limit counts in the plain step's figure: see beside_step()

  /// Returns the violation as a share of the limit (absolute where the limit is 0); 0 or less where the condition holds. It is
  /// infinity for a value that is not finite: that of a switch that failed.
  [[nodiscard]] double violation(double value) const;
  [[nodiscard]] bool holds(double value) const;
};

/// Reads "t_p < 60 us", or beside the plain step: "t_i < 3 step". Throws InvalidInput with the broken rule.
[[nodiscard]] Criterion parse_criterion(std::string_view text, std::span<const Figure> figures);

/// Returns a condition beside the plain step with an absolute limit, given the step's value of the figure. Throws InvalidInput
/// where the step has none, or 0.
[[nodiscard]] Criterion beside_step(Criterion criterion, double of_step);

/// The measure that a search minimises over the devices of a spread.
struct RobustMeasure {
  Risk risk;                       ///< risk of the cost of a closing; where `yield` is given, over the devices that break it
  std::optional<Criterion> yield;  ///< condition whose share of devices is maximised
  std::string text;                ///< the text as given
};

/// Reads cvar:LEVEL, quantile:LEVEL, mean+Ksigma, worst, yield:CONDITION, yield (no significant rebound). Throws InvalidInput
/// with the broken rule.
[[nodiscard]] RobustMeasure parse_robust_measure(std::string_view text, std::span<const Figure> figures);

}  // namespace softland
