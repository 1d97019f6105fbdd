#include "apps/pull_in_words.h"

#include <cmath>

#include "model/pull_in.h"
#include "reports/quantity.h"

namespace softland::apps {

using nlohmann::json;

json pull_in_of(const Prepared& p, std::size_t k, const Watch& watch) {
  const StaticPullIn s = static_pull_in(p.model, k);
  const DynamicPullIn d = dynamic_pull_in(p.model, k, s, watch);
  const auto number = [](double v) { return std::isfinite(v) ? json(v) : json(nullptr); };
  return {{"status", to_string(s.status == Status::done ? d.status : s.status)},
          {"pull_in",
           {{"static_V", number(s.voltage)},
            {"static_kind", to_string(s.kind)},
            {"dynamic_V", number(d.voltage)},
            {"release_V", number(release_voltage(p.model, k))}}}};
}

bool collapsed(const json& pull_in) { return pull_in["status"] == to_string(Status::collapsed_at_rest); }

std::string volts(const json& v) {
  constexpr int digits = 5;
  return v.is_number() ? internal::quantity(v.get<double>(), "V", digits) : "none";
}

std::string dynamic_words(const json& pull_in) {
  const json &statically = pull_in["static_V"], &dynamically = pull_in["dynamic_V"];
  const bool overdamped = statically.is_number() && dynamically.is_number() &&
                          dynamically.get<double>() >= (1 - dynamic_pull_in_precision) * statically.get<double>();
  return volts(dynamically) + (overdamped ? " (overdamped: equals the static one)" : "");
}

}  // namespace softland::apps
