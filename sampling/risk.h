// Measures of risk: each is one number for a sample of values of which larger ones are worse (statistics.h). A robust search
// minimises one of them.
//
//   cvar       conditional value at risk at a level: the mean of the worst 1 - level
//   quantile   the value below which a share `level` of the sample lies
//   mean+sigma mean + factor times the standard deviation
//   worst      the largest value
//
// CVaR uses every value of the tail, so that a single value changes it little. A quantile depends on one or two values. The
// mean plus a multiple of the standard deviation also increases if good (small) values lie farther from the mean. The worst
// value grows with the size of the sample. Source: R. T. Rockafellar & S. Uryasev, Journal of Risk 2 (2000) 21.
#pragma once

#include <span>

namespace softland {

enum class RiskKind { cvar, quantile, mean_sigma, worst };

struct Risk {
  RiskKind kind = RiskKind::cvar;
  double parameter = 0.9;  ///< level of cvar and quantile, factor on the standard deviation of mean_sigma
};

/// Returns the risk of a sample by one measure. Throws InvalidInput for a sample without values or with NaN, and for a
/// parameter outside [0, 1) (cvar), [0, 1] (quantile), [0, infinity) (mean_sigma).
[[nodiscard]] double risk(std::span<const double> sample, const Risk& measure);

}  // namespace softland
