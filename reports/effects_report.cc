#include "reports/effects_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

std::string percent(double change) {
  return std::isfinite(change) ? fmt::format("{:+.{}f} %", 100 * change, std::abs(change) < 10 ? 1 : 0) : "-";
}

std::string nanoseconds(double seconds) { return std::isfinite(seconds) ? fmt::format("{:.0f}", seconds * 1e9) : "-"; }

std::string cell(double value, double unit, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value / unit, digits) : "-";
}

std::string size_of(const NamedNumber& n) {
  if (!std::isfinite(n.value)) return {};
  return fmt::format("{} {:.3g}{}{}", n.name, n.value, n.unit.empty() ? "" : " ", n.unit);
}

// Each effect of the scene, left out.
std::string omissions_text(const Effects& effects) {
  const Effect& own = effects.own("gas");
  std::string text =
      fmt::format("{:<26}{:<18}{:>10}{:>10}{:>10}{:>9}  {}\n", "left out", "", "t_i", "v_i", "B_H", "ns/rhs", "size");
  for (const Omission& o : effects.omissions) {
    const auto change = [&](double Metrics::*figure) {
      return percent((o.metrics.*figure - own.metrics.*figure) / (own.metrics.*figure));
    };
    const std::string group = size_of(o.what.group);
    text += fmt::format("{:<26}{:<18}{:>10}{:>10}{:>10}{:>9}  {}{}{}\n", o.what.effect, o.what.choice,
                        change(influences[0].figure), change(influences[1].figure), change(influences[2].figure),
                        nanoseconds(o.rhs_seconds), size_of(o.what.magnitude), group.empty() ? "" : "; ", group);
  }
  if (effects.omissions.empty()) text += "nothing: the scene describes no effect that it could do without\n";
  text += fmt::format("{:<26}{:<18}{:>10}{:>10}{:>10}{:>9}\n", "nothing", "", "", "", "", nanoseconds(own.rhs_seconds));
  return text + "\n" +
         wrapped(
             "How the figures change when one effect is left out, under the same voltages, and what a right-hand side then "
             "costs. "
             "simulate.effects = \"auto\" leaves out what changes them by less than simulate.effects_tolerance.") +
         "\n\n";
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
  json left_out = json::array();
  for (const Omission& o : effects.omissions) {
    json change = json::object();
    const Metrics& own = effects.own("gas").metrics;
    for (const Influence& i : influences) change[i.key] = number((o.metrics.*i.figure - own.*i.figure) / (own.*i.figure));
    left_out.push_back({{"effect", o.what.effect},
                        {"choice", o.what.choice},
                        {"magnitude", named(o.what.magnitude)},
                        {"dimensionless_group", named(o.what.group)},
                        {"metrics", metrics_json(o.metrics)},
                        {"relative_change", change},
                        {"influence", number(o.influence)},
                        {"rhs_s", number(o.rhs_seconds)}});
  }
  json spread = json::object();
  for (const Influence& i : influences) spread[i.key] = number(effects.spread("gas", i.figure));
  return {{"kind", "effects"},
          {"left_out", left_out},
          {"effects", list},
          {"relative_spread", {{"gas", spread}}},
          {"scene", resolved(prepared.scene, prepared.voltage_units()).json()},
          {"version", version},
          {"command", provenance.command}};
}

std::string effects_text(const Effects& effects) {
  const Effect& own = effects.own("gas");
  std::string text = omissions_text(effects);
  text += fmt::format("{:<20}{:>14}{:>12}{:>12}{:>10}{:>12}{:>10}{:>10}{:>10}{:>9}\n", "gas", "c [N s/m^2]", "Kn", "t_i [us]", "",
                      "v_i [m/s]", "", "B_H [nm]", "", "ns/rhs");
  for (const Effect& e : effects.list) {
    const auto change = [&](const Influence& i) { return e.in_scene ? "" : percent(relative_change(e, own, i.figure)); };
    text += fmt::format("{:<20}{:>14}{:>12}{:>12}{:>10}{:>12}{:>10}{:>10}{:>10}{:>9}\n", (e.in_scene ? "* " : "  ") + e.choice,
                        cell(e.magnitude.value, 1, 3), cell(e.group.value, 1, 3), cell(e.metrics.initial_contact_time, 1e-6, 5),
                        change(influences[0]), cell(e.metrics.impact_velocity, 1, 4), change(influences[1]),
                        cell(e.metrics.major_bounce_height, 1e-9, 4), change(influences[2]), nanoseconds(e.rhs_seconds));
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
  // One line per warning, with the laws it is about.
  std::vector<std::pair<std::string, std::string>> warnings;  // laws, what
  for (const Effect& e : effects.list) {
    for (const std::string& w : e.warnings) {
      const auto same = std::find_if(warnings.begin(), warnings.end(), [&](const auto& known) { return known.second == w; });
      if (same == warnings.end()) {
        warnings.emplace_back(e.choice, w);
      } else {
        same->first += ", " + e.choice;
      }
    }
  }
  for (const auto& [laws, what] : warnings) text += "\n" + wrapped(laws + ": " + what) + "\n";
  return text;
}

}  // namespace softland
