#include "reports/result_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/require.h"
#include "config/units.h"
#include "studies/prepared.h"

namespace softland::internal {

using nlohmann::json;

const json& at(const json& value, std::initializer_list<std::string_view> path) {
  static const json nothing;
  const json* here = &value;
  for (const std::string_view key : path) {
    if (!here->is_object()) return nothing;
    const auto found = here->find(key);
    if (found == here->end()) return nothing;
    here = &*found;
  }
  return *here;
}

double number(const json& value) { return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN(); }

double number(const json& value, std::initializer_list<std::string_view> path) { return number(at(value, path)); }

double drawable(double value) {
  constexpr double most = 1e100;
  if (!(std::abs(value) <= most)) return std::numeric_limits<double>::quiet_NaN();
  return std::abs(value) < 1 / most ? 0 : value;
}

double drawable(const json& value) { return drawable(number(value)); }

std::string text(const json& value, std::initializer_list<std::string_view> path) {
  const json& found = at(value, path);
  return found.is_string() ? found.get<std::string>() : std::string();
}

std::optional<bool> truth(const json& value, std::initializer_list<std::string_view> path) {
  const json& found = at(value, path);
  return found.is_boolean() ? std::optional<bool>(found.get<bool>()) : std::nullopt;
}

std::vector<double> numbers(const json& value) {
  std::vector<double> out;
  if (!value.is_array()) return out;
  out.reserve(value.size());
  for (const json& element : value) out.push_back(drawable(element));
  return out;
}

bool is_optimize(const json& result) {
  const std::string kind = text(result, {"kind"});
  return kind == "optimize" || (kind.empty() && !at(result, {"baseline"}).is_null());
}

const json& best_metrics(const json& result) {
  const json& of_best = at(result, {"best", "metrics"});
  return of_best.is_object() ? of_best : at(result, {"metrics"});
}

const json& baseline_metrics(const json& result) { return at(result, {"baseline", "metrics"}); }

double window_end(const json& result) {
  double end = std::numeric_limits<double>::quiet_NaN();
  for (const char* run : {"best", "baseline"}) {
    const json& times = at(result, {"curves", run, "time_s"});
    if (times.is_array() && !times.empty()) end = std::fmax(end, drawable(times.back()));
  }
  return end;
}

std::vector<double> evaluation_indices(const json& result) {
  std::vector<double> indices;
  const json& tried = at(result, {"search", "evaluations"});
  if (!tried.is_array()) return indices;
  for (const json& one : tried) {
    if (one.is_array() && !one.empty() && one[0].is_number()) indices.push_back(number(one[0]));
  }
  std::sort(indices.begin(), indices.end());
  return indices;
}

double evaluations_until(const std::vector<double>& indices, double index) {
  if (indices.empty()) return index;
  return static_cast<double>(std::upper_bound(indices.begin(), indices.end(), index) - indices.begin());
}

DriveScale drive_scale(std::string_view drive) {
  if (drive == dispersion_drive) return {.name = "Force factor", .unit = "", .rest = 1};
  return {.name = "Voltage", .unit = "V", .rest = 0};
}

double quantity_of(const json& value) {
  if (!value.is_string()) return number(value);
  try {
    return parse_quantity(value.get<std::string>()).value;
  } catch (const InvalidInput&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

DriveLimits drive_limits(const json& result, const std::string& drive) {
  const json& driver = at(result, {"scene", "driver", drive});
  return {.lowest = quantity_of(at(driver, {"min_voltage"})),
          .highest = quantity_of(at(driver, {"max_voltage"})),
          .slew = quantity_of(at(driver, {"max_slew"}))};
}

double DriveDemand::peak() const { return std::max(std::abs(lowest), std::abs(highest)); }

DriveDemand drive_demand(const json& waveform, double rest) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  DriveDemand demand{.lowest = infinity, .highest = -infinity};
  double time = 0, level = rest;
  if (waveform.is_array()) {
    for (const json& point : waveform) {
      if (!point.is_array() || point.size() != 2 || !std::isfinite(number(point[0])) || !std::isfinite(number(point[1])))
        continue;
      const double next = number(point[0]), to = number(point[1]);
      if (to != level) demand.slew = std::max(demand.slew, next > time ? std::abs(to - level) / (next - time) : infinity);
      demand.lowest = std::min(demand.lowest, to);
      demand.highest = std::max(demand.highest, to);
      time = next;
      level = to;
    }
  }
  if (demand.lowest > demand.highest) demand.lowest = demand.highest = demand.slew = std::numeric_limits<double>::quiet_NaN();
  return demand;
}

double significant_rebound(const json& result) {
  constexpr double usual = 1e-9;
  const json& given = at(result, {"scene", "metrics", "significant_rebound"});
  if (given.is_number() && given.get<double>() > 0) return given.get<double>();
  if (!given.is_string()) return usual;
  try {
    const Quantity q = parse_quantity(given.get<std::string>());
    return q.dimension == dimension::length && q.value > 0 ? q.value : usual;
  } catch (const InvalidInput&) {
    return usual;
  }
}

}  // namespace softland::internal
