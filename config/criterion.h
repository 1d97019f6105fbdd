// What a robust search is asked for, from text: a measure of risk ("cvar:0.9"), or a condition on a figure of merit
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
  double limit = 0;      ///< [SI unit of the figure, or that figure of the plain step]
  std::string text;      ///< as it was given
  bool of_step = false;  ///< the limit counts in the plain step's figure: see beside_step()

  /// By which part of the limit (by how much, where that is 0) the figure breaks the condition; 0 or less where it holds,
  /// infinity for a value that is not finite: that of a switch that failed.
  [[nodiscard]] double violation(double value) const;
  [[nodiscard]] bool holds(double value) const;
};

/// "t_p < 60 us", or beside the plain step: "t_i < 3 step". Throws InvalidInput with the broken rule.
[[nodiscard]] Criterion parse_criterion(std::string_view text, std::span<const Figure> figures);

/// Of a condition beside the plain step the same with a limit of its own, where the step has this figure. Throws InvalidInput
/// where the step has none, or 0.
[[nodiscard]] Criterion beside_step(Criterion criterion, double of_step);

/// What a search minimises over the devices of a spread.
struct RobustMeasure {
  Risk risk;                       ///< of the cost of a closing; of those that break `yield`, where it is given
  std::optional<Criterion> yield;  ///< the share of devices for which it holds is to be as large as possible
  std::string text;                ///< as it was given
};

/// cvar:LEVEL, quantile:LEVEL, mean+Ksigma, worst, yield:CONDITION, yield (of no significant rebound). Throws InvalidInput with
/// the broken rule.
[[nodiscard]] RobustMeasure parse_robust_measure(std::string_view text, std::span<const Figure> figures);

}  // namespace softland
