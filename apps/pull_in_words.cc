#include "apps/pull_in_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "model/pull_in.h"
#include "reports/quantity.h"

namespace softland::apps {

using nlohmann::json;

namespace {

// From where on the closed switch is pulled through: NaN where it is not, or there is no contact to hold it.
double pulled_through(const Switch& model, std::size_t k, std::vector<double> volts) {
  if (!model.has_contact() || !pulls_in(model.device(), k)) return std::numeric_limits<double>::quiet_NaN();
  volts[k] = release_voltage(model, k, volts);
  return std::isfinite(volts[k]) ? pull_through_voltage(model, k, volts) : volts[k];
}

}  // namespace

json pull_in_of(const Prepared& p, std::size_t k, const Watch& watch) {
  const std::vector<double> bias = bias_of(p.scene, k);
  const StaticPullIn s = static_pull_in(p.model, k, bias);
  const DynamicPullIn d = dynamic_pull_in(p.model, k, s, bias, watch);
  const auto number = [](double v) { return std::isfinite(v) ? json(v) : json(nullptr); };
  json found{{"status", to_string(s.status == Status::done ? d.status : s.status)},
             {"pull_in",
              {{"static_V", number(s.voltage)},
               {"static_kind", to_string(s.kind)},
               {"deflection_m", number(s.deflection)},
               {"dynamic_V", number(d.voltage)},
               {"release_V", number(release_voltage(p.model, k, bias))},
               {"pulled_through_V", number(pulled_through(p.model, k, bias))}}}};
  const std::vector<std::string> names = p.drive_names();
  for (std::size_t other = 0; other < names.size(); ++other) {
    if (bias[other] == 0) continue;
    if (names[other] == dispersion_drive) {
      found["bias_factor"][names[other]] = 1 + bias[other];
    } else {
      found["bias_V"][names[other]] = bias[other];
    }
  }
  return found;
}

std::string bias_words(const Prepared& p, std::size_t k) {
  const std::vector<double> bias = bias_of(p.scene, k);
  const std::vector<std::string> names = p.drive_names();
  std::vector<std::string> drives;
  for (std::size_t other = 0; other < names.size(); ++other) {
    if (bias[other] == 0) continue;
    drives.push_back(names[other] == dispersion_drive
                         ? fmt::format("{} factor {}", names[other], internal::plain_number(1 + bias[other], 5))
                         : fmt::format("{} {}", names[other], volts(bias[other])));
  }
  return fmt::format("{}", fmt::join(drives, ", "));
}

bool collapsed(const json& pull_in) { return pull_in["status"] == to_string(Status::collapsed_at_rest); }

std::string volts(const json& v) {
  constexpr int digits = 5;
  return v.is_number() ? internal::quantity(v.get<double>(), "V", digits) : "none";
}

std::string deflection_words(const json& pull_in) {
  constexpr int digits = 4;
  const json& deflection = pull_in["deflection_m"];
  return deflection.is_number() ? internal::quantity(deflection.get<double>(), "m", digits) : "none";
}

std::string dynamic_words(const json& pull_in) {
  const json &statically = pull_in["static_V"], &dynamically = pull_in["dynamic_V"];
  const bool overdamped = statically.is_number() && dynamically.is_number() &&
                          dynamically.get<double>() >= (1 - dynamic_pull_in_precision) * statically.get<double>();
  return volts(dynamically) + (overdamped ? " (overdamped: equals the static one)" : "");
}

}  // namespace softland::apps
