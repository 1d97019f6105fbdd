#include "reports/pull_in_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "model/pull_in.h"
#include "reports/json_number.h"
#include "reports/quantity.h"
#include "reports/result_json.h"
#include "studies/closing/by_modes.h"
#include "studies/closing/closed_state.h"
#include "studies/devices/stable_approach.h"

namespace softland {

using nlohmann::json;

json pull_in_of(const PreparedScene& p, std::size_t k, const Watch& watch, const PullInFinder& find_pull_in) {
  return pull_in_json(p, k, find_pull_in(p.model, k, bias_of(p.scene, k), watch));
}

json pull_in_json(const PreparedScene& p, std::size_t k, const ElectrodePullIn& known) {
  const std::vector<double> bias = bias_of(p.scene, k);
  const auto& [s, d] = known;
  const ClosedRange closed = closed_range(p.model, k, bias);
  const auto number = [](double v) { return std::isfinite(v) ? json(v) : json(nullptr); };
  json found{{"status", to_string(s.status == Status::done ? d.status : s.status)},
             {"pull_in",
              {{"static_V", number(s.voltage)},
               {"static_kind", std::isfinite(s.voltage) ? json(to_string(s.kind)) : json(nullptr)},
               {"deflection_m", number(s.deflection)},
               {"dynamic_V", number(d.voltage)},
               {"release_V", number(closed.release)},
               {"pulled_through_V", number(closed.pulled_through)}}}};
  found["pull_in"]["by_modes"] = nullptr;
  const bool was_found = d.status != Status::interrupted;  // who has stopped the search waits for no more modes
  if (const ModeLadder ladder(p); was_found && ladder.exists() && std::isfinite(s.voltage)) {
    const VoltagesByModes more = voltages_by_modes(ladder, p.scene, k, closed.pulled_through);
    for (const auto& [key, voltage] : {std::pair("static_V", &more.static_pull_in), std::pair("release_V", &more.release),
                                       std::pair("pulled_through_V", &more.pulled_through)}) {
      if (!voltage->values.empty()) found["pull_in"]["by_modes"][key] = internal::by_modes_json(*voltage);
    }
  }
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

json pull_in_json(const std::map<std::string, json>& by_name, const std::string& status) {
  json all{{"status", status}, {"pull_in", json::object()}};
  if (by_name.size() == 1) all = by_name.begin()->second;
  if (by_name.size() > 1)
    for (const auto& [name, one] : by_name) all["pull_in"][name] = one["pull_in"];
  all["electrodes"] = by_name;
  return all;
}

json pull_in_json(const PreparedScene& p, const Watch& watch) {
  const auto& electrodes = p.scene.device.electrodes;
  std::map<std::string, json> by_name;
  std::string status(to_string(Status::done));
  for (std::size_t k = 0; k < electrodes.size(); ++k) {
    json one = pull_in_of(p, k, watch);
    watch.throw_if_stopped();
    if (pulls_in(p.scene.device, k) && status == to_string(Status::done)) status = one["status"].get<std::string>();
    by_name[electrodes[k].name] = std::move(one);
  }
  json all = pull_in_json(by_name, status);
  all["stable_path"] = stable_path_of(p, watch).data;
  return all;
}

std::string bias_words(const PreparedScene& p, std::size_t k) {
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

std::string shift_words(const json& pull_in, const char* key) {
  const std::optional<ByModes> found =
      internal::read_by_modes(pull_in["by_modes"].is_object() ? pull_in["by_modes"][key] : json());
  return found ? shift_words(*found) : std::string();
}

std::string deflection_words(const json& pull_in) {
  constexpr int digits = 4;
  const json& deflection = pull_in["deflection_m"];
  return deflection.is_number() ? internal::quantity(deflection.get<double>(), "m", digits) : "none";
}

std::string dynamic_words(const PreparedScene& p, std::size_t k, const json& pull_in) {
  const json &statically = pull_in["static_V"], &dynamically = pull_in["dynamic_V"];
  const bool equal = statically.is_number() && dynamically.is_number() &&
                     dynamically.get<double>() >= (1 - dynamic_pull_in_precision) * statically.get<double>();
  if (!equal) return volts(dynamically);
  std::vector<double> levels = bias_of(p.scene, k);
  levels[k] = statically.get<double>();
  return volts(dynamically) + (leaves_at_rest(p.model, bias_of(p.scene, k), levels)
                                   ? " (the static one: no step moves it, from there on its rest is unstable)"
                                   : " (overdamped: equals the static one)");
}

StablePathFound stable_path_of(const PreparedScene& p, const Watch& watch) {
  constexpr std::uint64_t devices = 256, seed = 1;
  if (!p.model.has_contact()) return {};
  std::optional<StableApproach> found;
  if (p.model.has_piezo()) found = stable_approach(p, Actuator::pzt);
  if (!found && has_pulling_electrode(p.scene.device)) found = stable_approach(p, Actuator::electrostatic);
  if (!found) return {.words = "no drive alone reaches the contact through stable equilibria within its limits"};
  const std::string drive = found->drive == piezo_drive ? "piezo" : "electrode " + found->drive;
  StablePathFound all{.data = {{"drives", {found->drive}}, {"reaches_V", found->reaches}, {"limit_V", found->limit}},
                      .words = fmt::format("the {} alone reaches the contact at {} through stable equilibria", drive,
                                           internal::quantity(found->reaches, "V", 4))};
  all.data["share_of_devices"] = nullptr;
  if (p.scene.spread.empty()) return all;
  const double share = share_with_path(p, *found, devices, seed, 1, watch);
  all.data["share_of_devices"] = share;
  all.words += fmt::format("; {} of devices do within {}", internal::percent(share), internal::given_quantity(found->limit, "V"));
  return all;
}

}  // namespace softland
