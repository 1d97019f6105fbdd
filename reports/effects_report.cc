#include "reports/effects_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "reports/findings.h"
#include "reports/json_number.h"
#include "reports/made_with.h"
#include "reports/quantity.h"
#include "reports/text.h"
#include "version.h"

namespace softland {
namespace {

using internal::json_number;
using nlohmann::json;

struct Influence {
  const char* key;   // in the JSON
  const char* name;  // in the table
  double Metrics::*figure;
};
constexpr Influence influences[] = {{"initial_contact_time", "t_i", &Metrics::initial_contact_time},
                                    {"impact_velocity", "v_i", &Metrics::impact_velocity},
                                    {"major_bounce_height", "B_H", &Metrics::major_bounce_height}};

json named(const NamedNumber& n) { return {{"name", n.name}, {"unit", n.unit}, {"value", json_number(n.value)}}; }

std::string size_of(const NamedNumber& n) {
  return std::isfinite(n.value) ? fmt::format("{} {}", n.name, internal::quantity(n.value, n.unit)) : std::string();
}

// Each effect of the scene, left out.
std::string omissions_text(const Effects& effects) {
  const Effect& own = effects.own("gas");
  std::string text = fmt::format("{:<26}{:<18}{:>10}{:>10}{:>10}{:>9}  {}\n", "left out", "", "t_i", "v_i", "B_H", "rhs", "size");
  for (const Omission& o : effects.omissions) {
    const auto change = [&](double Metrics::*figure) {
      return internal::relative_change((o.metrics.*figure - own.metrics.*figure) / (own.metrics.*figure));
    };
    const std::string group = size_of(o.what.group);
    text += fmt::format("{:<26}{:<18}{:>10}{:>10}{:>10}{:>9}  {}{}{}\n", o.what.effect, internal::with_true_minus(o.what.choice),
                        change(influences[0].figure), change(influences[1].figure), change(influences[2].figure),
                        internal::quantity(o.rhs_seconds, "s"), size_of(o.what.magnitude), group.empty() ? "" : "; ", group);
  }
  if (effects.omissions.empty()) text += "nothing: the scene describes no effect that it could do without\n";
  text +=
      fmt::format("{:<26}{:<18}{:>10}{:>10}{:>10}{:>9}\n", "nothing", "", "", "", "", internal::quantity(own.rhs_seconds, "s"));
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
    for (const Influence& i : influences) change[i.key] = json_number(relative_change(e, effects.own(e.section), i.figure));
    list.push_back({{"section", e.section},
                    {"choice", e.choice},
                    {"in_scene", e.in_scene},
                    {"status", to_string(e.metrics.status)},
                    {"magnitude", named(e.magnitude)},
                    {"dimensionless_group", named(e.group)},
                    {"metrics", metrics_json(e.metrics)},
                    {"relative_change", change},
                    {"rhs_s", json_number(e.rhs_seconds)},
                    {"warnings", e.warnings}});
  }
  json not_compared = json::array();
  for (const NotCompared& n : effects.not_compared) not_compared.push_back({{"choice", n.choice}, {"reason", n.reason}});
  json left_out = json::array();
  for (const Omission& o : effects.omissions) {
    json change = json::object();
    const Metrics& own = effects.own("gas").metrics;
    for (const Influence& i : influences) change[i.key] = json_number((o.metrics.*i.figure - own.*i.figure) / (own.*i.figure));
    left_out.push_back({{"effect", o.what.effect},
                        {"choice", o.what.choice},
                        {"magnitude", named(o.what.magnitude)},
                        {"dimensionless_group", named(o.what.group)},
                        {"metrics", metrics_json(o.metrics)},
                        {"relative_change", change},
                        {"influence", json_number(o.influence)},
                        {"rhs_s", json_number(o.rhs_seconds)}});
  }
  json spread = json::object();
  for (const Influence& i : influences) spread[i.key] = json_number(effects.spread("gas", i.figure));
  return {{"kind", "effects"},
          {"status", to_string(effects.interrupted ? Status::interrupted : effects.own("gas").metrics.status)},
          {"left_out", left_out},
          {"effects", list},
          {"not_compared", not_compared},
          {"relative_spread", {{"gas", spread}}},
          {"scene", resolved(prepared.scene, prepared.voltage_units()).json()},
          {"version", version},
          {"made_with", made_with()},
          {"command", provenance.command}};
}

std::string effects_text(const Effects& effects) {
  const Effect& own = effects.own("gas");
  std::string text = effects.interrupted ? "Interrupted: what follows is not all.\n\n" : "";
  if (!std::isfinite(own.metrics.initial_contact_time)) {
    const json closing{{"kind", "simulate"},
                       {"status", to_string(own.metrics.status)},
                       {"metrics", metrics_json(own.metrics)},
                       {"curves", {{"best", {{"time_s", {effects.window}}}}}}};
    text += wrapped(internal::headline(closing).main +
                    " So there are no figures to compare; below stand the size and the cost of each effect.") +
            "\n\n";
  }
  text += omissions_text(effects);
  const auto row = [](const auto&... cells) {
    return fmt::format("{:<20}{:>16}{:>8}{:>10}{:>9}{:>12}{:>9}{:>10}{:>9}{:>9}\n", cells...);
  };
  text += row("gas", "c", "Kn", "t_i", "", "v_i", "", "B_H", "", "rhs");
  for (const Effect& e : effects.list) {
    const auto change = [&](const Influence& i) {
      return e.in_scene ? "" : internal::relative_change(relative_change(e, own, i.figure));
    };
    text += row((e.in_scene ? "* " : "  ") + e.choice, internal::quantity(e.magnitude.value, e.magnitude.unit),
                internal::quantity(e.group.value, e.group.unit), internal::quantity(e.metrics.initial_contact_time, "s", 4),
                change(influences[0]), internal::quantity(e.metrics.impact_velocity, "m/s", 4), change(influences[1]),
                internal::quantity(e.metrics.major_bounce_height, "m", 4), change(influences[2]),
                internal::quantity(e.rhs_seconds, "s"));
  }
  text += "\n" +
          wrapped(
              "* the scene's own. c is the damping per length and Kn the Knudsen number at the gap of the closed tip; every "
              "other column is of the whole closing, its change is relative to the scene's own.") +
          "\n\n";
  std::string words;
  for (const Influence& i : influences) {
    if (!std::isfinite(own.metrics.*i.figure)) continue;
    const double spread = effects.spread("gas", i.figure);
    words +=
        fmt::format("{}{} {}", words.empty() ? "" : ", ", i.name, std::isfinite(spread) ? internal::percent(spread) : "unknown");
  }
  text += wrapped(words.empty()
                      ? "The gas laws cannot be compared: the switch does not close in the scene's own."
                      : "The gas laws differ on this scene, largest less smallest over the scene's own, by: " + words + ".") +
          "\n";
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
  for (const NotCompared& n : effects.not_compared) text += "\n" + wrapped(n.choice + " is not compared: " + n.reason) + "\n";
  for (const auto& [laws, what] : warnings) text += "\n" + wrapped(laws + ": " + what) + "\n";
  return text;
}

}  // namespace softland
