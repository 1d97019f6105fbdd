#include "sampling/risk.h"

#include <cmath>

#include "base/require.h"
#include "sampling/statistics.h"

namespace softland {

double risk(std::span<const double> sample, const Risk& measure) {
  switch (measure.kind) {
    case RiskKind::cvar:
      return conditional_value_at_risk(sample, measure.parameter);
    case RiskKind::quantile:
      return sample_quantile(sample, measure.parameter);
    case RiskKind::mean_sigma: {
      require(measure.parameter >= 0 && std::isfinite(measure.parameter),
              "the factor of the standard deviation must be finite and at least 0");
      const double deviation = sample.size() > 1 ? sample_standard_deviation(sample) : 0;
      return measure.parameter == 0 ? sample_mean(sample) : sample_mean(sample) + measure.parameter * deviation;
    }
    case RiskKind::worst:
      break;
  }
  return sample_quantile(sample, 1);
}

}  // namespace softland
