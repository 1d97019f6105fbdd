#include "reports/fit_text.h"

#include <fmt/format.h>

#include <cmath>

#include "document/quantity.h"
#include "reports/study_members.h"

namespace softland {

using internal::plain_number;
using internal::quantity;

std::string label_of(const FittedUnknown& u) { return u.device.empty() ? u.name : fmt::format("{} of {}", u.name, u.device); }

std::string in_unit(double value, const std::string& unit, int digits) {
  return unit == "kg" ? quantity(1e3 * value, "g", digits) : quantity(value, unit, digits);
}

std::string fitted_value_text(const FittedUnknown& u, double value, double error) {
  if (!std::isfinite(value)) return "—";
  if (u.unit.empty()) return internal::relative_change(value - 1);
  if (u.unit == "kg") return internal::quantity_within(1e3 * value, 1e3 * error, "g", 6);
  return internal::quantity_within(value, error, u.unit, 6);
}

std::string nominal_text(const FittedUnknown& u) {
  if (u.unit.empty()) return "—";
  return u.unit == "kg" ? internal::given_quantity(1e3 * u.nominal, "g") : internal::given_quantity(u.nominal, u.unit);
}

std::string fitted_error_text(const FittedUnknown& u) {
  // Least standard error of an unknown of the fit, in its scale (its standard deviation in [spread], or a tenth of its value in
  // the scene), for which the report says "not known" instead of a number.
  constexpr double nothing = 100;
  if (!(u.standard_error < nothing * u.scale)) return "not known";
  if (u.unit.empty()) return plain_number(100 * u.standard_error, 2) + "\u00a0%";
  const std::string share =
      u.value != 0 ? fmt::format(" ({}\u00a0%)", plain_number(100 * std::abs(u.standard_error / u.value), 2)) : "";
  return in_unit(u.standard_error, u.unit, 2) + share;
}

std::string fitted_interval_text(const FittedUnknown& u) {
  if (!std::isfinite(u.low)) return "—";
  return fmt::format("{} to {}", fitted_value_text(u, u.low, u.standard_error), fitted_value_text(u, u.high, u.standard_error));
}

std::string fitted_prior_text(const FittedUnknown& u) {
  if (!std::isfinite(u.prior_mean)) return "none";
  if (u.unit.empty()) return fmt::format("±\u00a0{}\u00a0%", plain_number(100 * u.prior_deviation, 2));
  return fmt::format("±\u00a0{}", in_unit(u.prior_deviation, u.unit, 2));
}

std::string what_text(const FitResidual& r) {
  std::string text(row_of(r.what).words);
  if (r.level) text += " at " + quantity(*r.level, "V", 4);
  if (r.time) text += " at " + quantity(*r.time, "s", 4);
  if (!r.device.empty()) text += " of " + r.device;
  return text;
}

}  // namespace softland
