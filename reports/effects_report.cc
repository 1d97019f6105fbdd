#include "reports/effects_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/choice.h"
#include "base/require.h"
#include "document/document.h"
#include "document/json_number.h"
#include "document/quantity.h"
#include "reports/closing_captions.h"
#include "reports/study_members.h"

namespace softland {
namespace {

using internal::json_number;
using nlohmann::json;

// Returns the relative change of a figure of merit if an effect is left out: `metrics` are the figures without the effect,
// `own` the figures of the complete scene.
double change(const Figure& figure, const Metrics& metrics, const Metrics& own) {
  return relative_change(figure.value(metrics), figure.value(own));
}

// Writes each closing without an effect, with the changes of its figures from the closing of the complete scene.
template <class Closing>
json compared_json(const std::vector<Closing>& closings, const Metrics& own) {
  json all = json::array();
  for (const Closing& closing : closings) {
    json& one = all.emplace_back(internal::record_json(closing));
    for (const Figure& f : compared_figures)
      one["relative_change"][std::string(f.quantity())] = json_number(change(f, closing.metrics, own));
  }
  return all;
}

std::string size_of(const NamedNumber& n) {
  return std::isfinite(n.value) ? fmt::format("{} {}", n.name, internal::quantity(n.value, n.unit)) : std::string();
}

// Returns a table with a row for each physical effect: the closing without this effect.
ReportTable omissions_table(const Effects& effects) {
  const Effect& own = effects.own("gas");
  ReportTable table{.head = {"left out", {"", "words"}}, .rows = {}};
  for (const Figure& f : compared_figures) table.head.emplace_back(f.symbol);
  table.head.insert(table.head.end(), {"rhs", {"size", "words"}});
  for (const EffectAblation& o : effects.ablations) {
    TableRow& row = table.rows.emplace_back(TableRow{o.what.effect, internal::with_true_minus(o.what.choice)});
    for (const Figure& f : compared_figures) row.emplace_back(internal::relative_change(change(f, o.metrics, own.metrics)));
    const std::string group = size_of(o.what.group);
    row.emplace_back(internal::quantity(o.rhs_seconds, "s"));
    row.emplace_back(size_of(o.what.magnitude) + (group.empty() ? "" : "; ") + group);
  }
  TableRow nothing{"nothing"};
  nothing.resize(2 + compared_figures.size(), "");
  nothing.emplace_back(internal::quantity(own.rhs_seconds, "s"));
  table.rows.push_back(std::move(nothing));
  return table;
}

ReportTable laws_table(const Effects& effects) {
  const Effect& own = effects.own("gas");
  ReportTable table{.head = {"gas", "c", "Kn"}, .rows = {}};
  for (const Figure& f : compared_figures) table.head.insert(table.head.end(), {f.symbol, ""});
  table.head.emplace_back("rhs");
  for (const Effect& e : effects.list) {
    TableRow& row = table.rows.emplace_back(TableRow{(e.in_scene ? "* " : "  ") + e.choice,
                                                     internal::quantity(e.magnitude.value, e.magnitude.unit),
                                                     internal::quantity(e.group.value, e.group.unit)});
    for (const Figure& f : compared_figures) {
      row.emplace_back(internal::quantity(f.value(e.metrics), f.unit, 4));
      row.emplace_back(e.in_scene ? "" : internal::relative_change(change(f, e.metrics, own.metrics)));
    }
    row.emplace_back(internal::quantity(e.rhs_seconds, "s"));
  }
  return table;
}

std::string spread_of_laws(const Effects& effects) {
  std::string words;
  bool is_closed = false;
  for (const Figure& f : compared_figures) {
    if (!std::isfinite(f.value(effects.own("gas").metrics))) continue;
    is_closed = true;
    const double spread = effects.spread("gas", f);
    if (std::isfinite(spread)) words += fmt::format("{}{} {}", words.empty() ? "" : ", ", f.symbol, internal::percent(spread));
  }
  if (!is_closed) return "The gas laws cannot be compared: the switch does not close under that of the scene.";
  return words.empty()
             ? "There is no relative range of the figures over the gas laws: the switch does not close under some of them."
             : "Relative range of the figures over the gas laws (largest minus smallest value, over that of the scene): " +
                   words + ".";
}

// Returns a line per closing whose simulation stopped before the end of the simulated time.
std::vector<std::string> bounds_of(const Effects& effects) {
  std::vector<std::string> lines;
  const auto tell = [&](const std::string& closing, const Metrics& figures, const std::optional<double>& end) {
    if (!end) return;
    const std::string closes =
        std::isfinite(figures.initial_contact_time) ? "its figures are those of that time" : "it does not close in that time";
    lines.push_back(fmt::format("{} is simulated for {} only, because it costs far more than that of the scene: {}.", closing,
                                internal::quantity(*end, "s"), closes));
  };
  for (const EffectAblation& o : effects.ablations) tell(fmt::format("The closing without {}", o.what.effect), o.metrics, o.end);
  for (const Effect& e : effects.list) {
    tell(e.choice == "none" ? "The closing without gas" : fmt::format("The closing under {}", e.choice), e.metrics, e.end);
  }
  return lines;
}

// Returns a sentence with the gas laws under which the switch does not close in the whole simulated time; empty if there are
// none.
std::string laws_without_contact(const Effects& effects) {
  std::vector<std::string> laws;
  for (const Effect& e : effects.list) {
    if (!e.in_scene && !e.end && e.metrics.status == Status::no_contact) laws.push_back(e.choice == "none" ? "no gas" : e.choice);
  }
  if (laws.empty()) return {};
  return fmt::format("The switch does not close within the simulated {} under {}.", internal::quantity(effects.window, "s"),
                     in_words(laws));
}

// Returns the symbols of the compared figures with their names: "t_i: first contact, v_i: impact velocity".
std::string symbols_in_words() {
  std::string words;
  for (const Figure& f : compared_figures) {
    std::string name(f.name);
    name.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(name.front())));
    words += fmt::format("{}{} is the {}", words.empty() ? "" : ", ", f.symbol, name);
  }
  return words;
}

// Returns a line per warning, with the names of the laws to which the warning applies.
std::vector<std::string> warnings_of(const Effects& effects) {
  // Per warning: names of the laws to which it applies, and its text.
  std::vector<std::pair<std::string, std::string>> warnings;
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
  std::vector<std::string> lines;
  for (const NotCompared& n : effects.not_compared) lines.push_back(n.choice + " is not compared: " + n.reason);
  for (const auto& [laws, what] : warnings) {
    const bool names_the_law = what.starts_with("gas law " + laws + ":");
    lines.push_back(names_the_law ? what : fmt::format("{}: {}", laws, what));
  }
  return lines;
}

}  // namespace

void members(internal::Archive& a, Effect& effect) {
  a("section", effect.section, "section of the law, such as `gas`");
  a("choice", effect.choice, "name of the law; `none`: left out");
  a("in_scene", effect.in_scene, "whether it is that of the scene");
  a("status", effect.metrics.status, "outcome of the closing");
  a("magnitude", effect.magnitude, "size of the effect");
  a("dimensionless_group", effect.group, "group that decides whether the law is valid");
  a("metrics", effect.metrics, "figures of the closing");
  a("rhs_s", effect.rhs_seconds, "computing time per evaluation of the right-hand side");
  a("warnings", effect.warnings, "warnings of the closing");
  a("followed_until_s", effect.end, "time at which a costly closing was stopped");
}

void members(internal::Archive& a, NotCompared& law) {
  a("choice", law.choice, "name of the law");
  a("reason", law.reason, "why it cannot be compared");
}

void members(internal::Archive& a, EffectAblation& one) {
  a("effect", one.what.effect, "name of the effect");
  a("choice", one.what.choice, "what the scene has");
  a("magnitude", one.what.magnitude, "size of the effect");
  a("dimensionless_group", one.what.group, "group that decides whether the effect matters");
  a("metrics", one.metrics, "figures of the closing without it");
  a("influence", one.influence, "largest relative change of a figure");
  a("rhs_s", one.rhs_seconds, "computing time per evaluation of the right-hand side");
  a("followed_until_s", one.end, "time at which a costly closing was stopped");
}

// The JSON of compared_json().
template <class Closing>
struct ComparedJson {};
template <class Closing>
void members(internal::Archive& a, ComparedJson<Closing>&) {
  Closing closing;
  members(a, closing);
  a("relative_change", std::map<std::string, double>{}, "relative change of each compared figure from the closing of the scene");
}

void members(internal::Archive& a, EffectsRecord& record) {
  Effects& found = record.found;
  members(a, record.origin);
  const auto compared = [&](const auto& closings) { return compared_json(closings, found.own("gas").metrics); };
  a.custom("effects", found.list, compared, internal::read_json<std::vector<Effect>>,
           internal::Like<std::vector<ComparedJson<Effect>>>{"closings with each law"});
  require(std::ranges::any_of(found.list, [](const Effect& e) { return e.in_scene && e.section == "gas"; }),
          "\"effects\" lacks the gas of the scene");
  a.custom("left_out", found.ablations, compared, internal::read_json<std::vector<EffectAblation>>,
           internal::Like<std::vector<ComparedJson<EffectAblation>>>{"closings without each effect"});
  a("not_compared", found.not_compared, "laws that are impossible for the scene");
  a("duration_s", found.window, "simulated time");
  a.custom(
      "status", found.interrupted,
      [&](bool stopped) { return json(to_string(stopped ? Status::interrupted : found.own("gas").metrics.status)); },
      [](const json& status) { return status == to_string(Status::interrupted); },
      internal::Like<std::string>{"outcome of the closing of the scene, or `interrupted`"});
  std::map<std::string, double> spread;
  for (const Figure& f : compared_figures) spread[std::string(f.quantity())] = found.spread("gas", f);
  a.derived("relative_spread", std::map<std::string, std::map<std::string, double>>{{"gas", std::move(spread)}},
            "by section, range of each figure over the laws, relative to that of the scene");
}

json json_of(const EffectsRecord& record) { return internal::record_json(record); }

EffectsRecord read_effects(const json& from) { return internal::whole_record<EffectsRecord>(from); }

std::string text_of(const EffectsRecord& record) {
  const Effects& effects = record.found;
  const Effect& own = effects.own("gas");
  Document document{.doubt = effects.interrupted ? "Interrupted: the results are incomplete." : ""};
  if (!std::isfinite(own.metrics.initial_contact_time)) {
    ClosingRecord closing{.status = std::string(to_string(own.metrics.status))};
    closing.best = {.status = closing.status, .figures = FigureValues(own.metrics)};
    closing.best.curve.time = {effects.window};
    document.headline = internal::headline(closing).main;
    document.headline_rest = " There are no figures to compare; the table has the size and the cost of each effect.";
  }
  ReportSection left_out{.id = "left-out", .heading = "Each effect left out", .parts = {}};
  if (effects.ablations.empty())
    left_out.parts.emplace_back(Paragraph{effects.interrupted
                                              ? "Interrupted before any effect was left out."
                                              : "Nothing is left out: the scene has no effect that can be left out."});
  left_out.parts.emplace_back(omissions_table(effects));
  left_out.parts.emplace_back(Paragraph{
      "The columns have the change of the figures when one effect is left out under the same voltages: " + symbols_in_words() +
      ". rhs is the computing time of one evaluation of the right-hand side without the effect. simulate.effects = "
      "\"auto\" leaves out the effects that change the figures by less than simulate.effects_tolerance."});
  ReportSection laws{.id = "laws",
                     .heading = "Other gas laws",
                     .parts = {laws_table(effects),
                               Paragraph{"* is the gas law of the scene. c is the damping per length and Kn the Knudsen number, "
                                         "both at the gap of the closed tip. The other columns are figures of the whole closing, "
                                         "with their change relative to the law of the scene."},
                               Paragraph{spread_of_laws(effects)}}};
  if (const std::string laws_that_stay_open = laws_without_contact(effects); !laws_that_stay_open.empty())
    laws.parts.emplace_back(Paragraph{laws_that_stay_open});
  for (const std::string& line : bounds_of(effects)) laws.parts.emplace_back(Paragraph{line});
  for (const std::string& line : warnings_of(effects)) laws.parts.emplace_back(Paragraph{line});
  document.sections = {std::move(left_out), std::move(laws)};
  return terminal_text(document);
}

}  // namespace softland
