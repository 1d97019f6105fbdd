#include "reports/effects_report.h"

#include <fmt/format.h>

#include <cmath>

#include "reports/text.h"
#include "version.h"

namespace softland {
namespace {

using nlohmann::json;

struct Influence {
  const char* key;   // in the JSON
  const char* name;  // in the table
  double Metrics::*figure;
};
constexpr Influence influences[] = {{"initial_contact_time", "t_i", &Metrics::initial_contact_time},
                                    {"impact_velocity", "v_i", &Metrics::impact_velocity},
                                    {"major_bounce_height", "B_H", &Metrics::major_bounce_height}};

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json named(const NamedNumber& n) { return {{"name", n.name}, {"unit", n.unit}, {"value", number(n.value)}}; }

std::string percent(double change) { return std::isfinite(change) ? fmt::format("{:+.1f} %", 100 * change) : "-"; }

std::string cell(double value, double unit, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value / unit, digits) : "-";
}

}  // namespace

json effects_json(const Prepared& prepared, const Effects& effects, const Provenance& provenance) {
  json list = json::array();
  for (const Effect& e : effects.list) {
    json change = json::object();
    for (const Influence& i : influences) change[i.key] = number(relative_change(e, effects.own(e.section), i.figure));
    list.push_back({{"section", e.section},
                    {"choice", e.choice},
                    {"in_scene", e.in_scene},
                    {"status", to_string(e.metrics.status)},
                    {"magnitude", named(e.magnitude)},
                    {"dimensionless_group", named(e.group)},
                    {"metrics", metrics_json(e.metrics)},
                    {"relative_change", change},
                    {"rhs_s", number(e.rhs_seconds)},
                    {"warnings", e.warnings}});
  }
  json spread = json::object();
  for (const Influence& i : influences) spread[i.key] = number(effects.spread("gas", i.figure));
  return {{"kind", "effects"},
          {"effects", list},
          {"relative_spread", {{"gas", spread}}},
          {"scene", resolved(prepared.scene, prepared.voltage_units()).json()},
          {"version", version},
          {"command", provenance.command}};
}

std::string effects_text(const Effects& effects) {
  const Effect& own = effects.own("gas");
  std::string text = fmt::format("{:<20}{:>14}{:>12}{:>12}{:>10}{:>12}{:>10}{:>10}{:>10}{:>9}\n", "gas", "c [N s/m^2]", "Kn",
                                 "t_i [us]", "", "v_i [m/s]", "", "B_H [nm]", "", "ns/rhs");
  for (const Effect& e : effects.list) {
    const auto change = [&](const Influence& i) { return e.in_scene ? "" : percent(relative_change(e, own, i.figure)); };
    text += fmt::format("{:<20}{:>14}{:>12}{:>12}{:>10}{:>12}{:>10}{:>10}{:>10}{:>9}\n", (e.in_scene ? "* " : "  ") + e.choice,
                        cell(e.magnitude.value, 1, 3), cell(e.group.value, 1, 3), cell(e.metrics.initial_contact_time, 1e-6, 5),
                        change(influences[0]), cell(e.metrics.impact_velocity, 1, 4), change(influences[1]),
                        cell(e.metrics.major_bounce_height, 1e-9, 4), change(influences[2]),
                        std::isfinite(e.rhs_seconds) ? fmt::format("{:.0f}", e.rhs_seconds * 1e9) : "-");
  }
  text += "\n" +
          wrapped(
              "* the scene's own. c is the damping per length and Kn the Knudsen number at the gap of the closed tip; every "
              "other column is of the whole closing, its change is relative to the scene's own.") +
          "\n\n";
  std::string words;
  for (const Influence& i : influences) {
    const double spread = effects.spread("gas", i.figure);
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", i.name,
                         std::isfinite(spread) ? fmt::format("{:.1f} %", 100 * spread) : "unknown");
  }
  text += wrapped("The gas laws differ on this scene, largest less smallest over the scene's own, by: " + words + ".") + "\n";
  for (const Effect& e : effects.list) {
    if (e.metrics.status != Status::done) text += fmt::format("\n{}: {}\n", e.choice, to_string(e.metrics.status));
    for (const std::string& w : e.warnings) text += "\n" + wrapped(e.choice + ": " + w) + "\n";
  }
  return text;
}

}  // namespace softland
