// Numbers and names in the results of a fit as text.
#pragma once

#include <string>

#include "studies/inverse/fit.h"

namespace softland {

/// Returns the name of an unknown of a fit, with its device if there are several devices.
[[nodiscard]] std::string label_of(const FittedUnknown& u);
/// Formats the value of an unknown or a measurement with its unit; a mass is in grams.
[[nodiscard]] std::string in_unit(double value, const std::string& unit, int digits = 3);
/// Formats the fitted value of an unknown; a factor is shown as the change of the value in the scene.
[[nodiscard]] std::string fitted_value_text(const FittedUnknown& u, double value, double error);
[[nodiscard]] std::string nominal_text(const FittedUnknown& u);
[[nodiscard]] std::string fitted_error_text(const FittedUnknown& u);
[[nodiscard]] std::string fitted_interval_text(const FittedUnknown& u);
[[nodiscard]] std::string fitted_prior_text(const FittedUnknown& u);
/// Names the measured quantity of a residual, with its voltage, time and device.
[[nodiscard]] std::string what_text(const FitResidual& r);

}  // namespace softland
