#include "reports/limit_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "reports/chart.h"
#include "reports/document.h"
#include "reports/json_number.h"
#include "reports/origin.h"
#include "reports/quantity.h"
#include "reports/result_json.h"
#include "reports/svg.h"
#include "studies/closing/summits_at_hold.h"

namespace softland {
namespace {

using internal::json_number;
using internal::quantity;
using nlohmann::json;

json least_json(const LeastTime& least) {
  return {{"status", to_string(least.status)},
          {"message", least.message},
          {"from_start", least.from_start},
          {"least_time_s", json_number(least.time)},
          {key_of(&Metrics::impact_velocity), json_number(least.impact_velocity)},
          {"peak_voltage_V", json_number(least.peak)},
          {"simulated_time_s", json_number(least.simulated_time)},
          {"simulated_impact_velocity_m_s", json_number(least.simulated_velocity)},
          {"distance_from_rest", json_number(least.room)}};
}

json list_json(const std::vector<LeastTime>& all) {
  json list = json::array();
  for (const LeastTime& least : all) list.push_back(least_json(least));
  return list;
}

json landing_json(const LimitLanding& landing) {
  json checks = json::array();
  for (const ConfirmingRun& c : landing.checks) {
    if (c.varied != Varied::gas) checks.push_back({{"name", c.name}, {"metrics", metrics_json(c.metrics)}});
  }
  return {{"way", least_json(landing.way)},
          {"at_rest", std::isfinite(landing.way.room)},
          {"catch_delay_s", json_number(landing.catch_delay)},
          {"catch_s", json_number(landing.catch_time)},
          {"bounce_free", landing.bounce_free},
          {"metrics", metrics_json(landing.closing.metrics)},
          {"confirmed_by", checks},
          {"scene", landing.scene.scene.file.json()}};
}

std::string drives_of(Actuator actuator) {
  switch (actuator) {
    case Actuator::electrostatic:
      return "the electrodes";
    case Actuator::pzt:
      return "the piezo";
    case Actuator::both:
      break;
  }
  return "electrodes and piezo";
}

std::string why_not(const LeastTime& least) {
  return least.message.empty() ? std::string(to_string(least.status)) : least.message;
}

TableRow least_row(const std::string& name, const LeastTime& least) {
  if (least.status != Status::done) return {name, "—", "—", why_not(least)};
  return {name, quantity(least.time, "s", 4), quantity(least.impact_velocity, "m/s"),
          least.from_start ? "found from the waveform of --start" : ""};
}

// Least times over what was varied, as `name` says it.
template <class Name>
ReportTable list_table(const char* title, const std::vector<LeastTime>& all, Name name) {
  ReportTable table{.head = {title, "least time", {"", "words"}}, .rows = {}};
  for (const LeastTime& least : all) {
    const bool done = least.status == Status::done;
    table.rows.push_back({name(least), done ? quantity(least.time, "s", 4) : "—", done ? "" : why_not(least)});
  }
  return table;
}

// The model for which a least time is a bound: a beam with more modes may touch earlier. Empty for a plate, which has one mode.
std::string model_of(const Limit& limit) {
  if (limit.given.scene.device.structure.is_rigid()) return {};
  const auto modes = limit.given.model.modes();
  return fmt::format("{} mode{}", modes, modes == 1 ? "" : "s");
}

// What follows the touch of a landing.
std::string words_after(const LimitLanding& landing) {
  if (landing.bounce_free) return "no rebound, confirmed";
  const Metrics& own = landing.closing.metrics;
  std::string words =
      own.major_bounce_height > 0 ? fmt::format("rebounds up to {}", quantity(own.major_bounce_height, "m")) : "no rebound";
  std::string others;
  for (const ConfirmingRun& c : landing.checks) {
    if (c.varied == Varied::gas) continue;
    if (c.metrics.bounce_count == 0 && c.metrics.status == Status::done) continue;
    const std::string course =
        c.metrics.bounce_count > 0 ? "up to " + quantity(c.metrics.major_bounce_height, "m") : std::string("it is not settled");
    others += fmt::format("{} {} {}", others.empty() ? ", but with" : ",", c.name, course);
  }
  words += others;
  return words;
}

std::string words_of_catch(const LimitLanding& landing) {
  const double pulled = landing.catch_time - landing.catch_delay;
  if (!(pulled > 0)) return "landing";
  std::string words = fmt::format("landing, then a catch of {}", quantity(pulled, "s"));
  if (landing.catch_delay > 0) words += fmt::format(" after {}", quantity(landing.catch_delay, "s"));
  return words;
}

ReportTable touches_table(const Limit& limit) {
  ReportTable table{.head = {"", "first touch", "speed", {"", "words"}}, .rows = {}};
  table.rows = {
      {"plain step", quantity(limit.step.initial_contact_time, "s", 4), quantity(limit.step.impact_velocity, "m/s")},
      least_row(fmt::format("least time of a touch at {} or less", quantity(limit.impact_velocity, "m/s")), limit.touch),
      least_row("least time with every mode at rest", limit.rest)};
  if (limit.landing) {
    const Metrics& m = limit.landing->closing.metrics;
    table.rows.push_back({words_of_catch(*limit.landing), quantity(m.initial_contact_time, "s", 4),
                          quantity(m.impact_velocity, "m/s"), words_after(*limit.landing)});
  }
  return table;
}

std::vector<std::string> all_warnings(const Limit& limit) {
  std::vector<std::string> all = limit.given.scene.warnings;
  if (!limit.hold_warning.empty()) all.push_back(limit.hold_warning);
  if (std::string few = few_summits_warning(limit.given.model, limit.given.signals()); !few.empty())
    all.push_back(std::move(few));
  return all;
}

// Column pairs of a curve; what was not found is left out.
template <class X>
void add_curve(internal::CurveTables& tables, const std::string& name, const std::vector<LeastTime>& all, X x) {
  for (const LeastTime& least : all) {
    if (least.status != Status::done) continue;
    tables[name]["x"].push_back(x(least));
    tables[name]["time"].push_back(least.time);
  }
}

internal::Chart curve(const std::string& table, const std::string& title, const std::string& x_label, const std::string& x_unit,
                      const internal::CurveTable& columns) {
  constexpr double beside = 0.1;  // of the only place of a curve: what is shown on either side
  const auto [low, high] = std::minmax_element(columns.at("x").begin(), columns.at("x").end());
  const double around = *low < *high ? 0 : beside * *low;
  internal::Chart chart{
      .id = table, .title = title, .x_column = "x", .x_label = x_label, .x_unit = x_unit, .y_label = "least time", .y_unit = "s"};
  chart.x_home = chart.x_whole = {*low - around, *high + around};
  chart.series = {{.table = table, .column = "time", .label = "least time of a touch"}};
  for (std::size_t k = 0; k < columns.at("x").size(); ++k)
    chart.marks.push_back({columns.at("x")[k], columns.at("time")[k], internal::Role::best, ""});
  return chart;
}

json quasi_static_json(const Limit& limit) {
  if (!limit.approach) return nullptr;
  return {{"drive", limit.approach->drive},
          {"touch_places_m", json_number(limit.approach->touch_places())},
          {"steady_s", json_number(limit.step.steady_force_time)},
          {"speed_m_s", json_number(limit.quasi_static)}};
}

// Says how softly one slow waveform can land all devices.
std::string quasi_static_words(const Limit& limit) {
  if (!limit.approach || !std::isfinite(limit.quasi_static)) return {};
  const std::string drive = limit.approach->drive == piezo_drive ? "piezo" : "electrode " + limit.approach->drive;
  return fmt::format(
      "The {} can carry the devices of [spread] to their contact slowly, through stable equilibria. The places where 90 % of "
      "them "
      "touch lie {} apart on its way. A waveform that passes them evenly, and is steady as soon as the plain step, at {}, "
      "touches "
      "at {} or more.",
      drive, quantity(limit.approach->touch_places(), "m"), quantity(limit.step.steady_force_time, "s"),
      quantity(limit.quasi_static, "m/s"));
}

}  // namespace

json limit_json(const Limit& limit, const Provenance& provenance) {
  return with_origin({{"kind", "limit"},
                      {"status", limit.interrupted ? "interrupted" : to_string(limit.touch.status)},
                      {"actuator", name_of(actuators, limit.options.actuator)},
                      {"permitted_impact_velocity_m_s", json_number(limit.impact_velocity)},
                      {"modes", limit.given.model.modes()},
                      {"plain_step", metrics_json(limit.step)},
                      {"touch", least_json(limit.touch)},
                      {"at_rest", least_json(limit.rest)},
                      {"quasi_static", quasi_static_json(limit)},
                      {"closed_state", closed_state_json(limit.closed_state)},
                      {"warnings", all_warnings(limit)},
                      {"landing", limit.landing ? landing_json(*limit.landing) : json()},
                      {"over_impact_velocity", list_json(limit.over_velocity)},
                      {"over_peak_voltage", list_json(limit.over_peak)}},
                     limit.given, provenance.command);
}

std::string limit_text(const Limit& limit) {
  const std::string peak = std::isfinite(limit.touch.peak) ? fmt::format(", up to {}", quantity(limit.touch.peak, "V")) : "";
  ReportSection section{.id = "least-times", .heading = "Least times", .parts = {}};
  if (!limit.hold_warning.empty()) section.parts.emplace_back(Paragraph{"warning: " + limit.hold_warning});  // before all figures
  section.parts.emplace_back(touches_table(limit));
  if (!limit.over_velocity.empty())
    section.parts.emplace_back(
        list_table("touch at or below", limit.over_velocity, [](const LeastTime& l) { return quantity(l.permitted, "m/s"); }));
  if (!limit.over_peak.empty())
    section.parts.emplace_back(
        list_table("volts up to", limit.over_peak, [](const LeastTime& l) { return quantity(l.peak, "V", 4); }));
  const std::string model = model_of(limit);
  if (limit.touch.status == Status::done || limit.rest.status == Status::done)
    section.parts.emplace_back(Paragraph{
        "No waveform of these drives touches earlier at that speed" + (model.empty() ? "" : " in this model of " + model) +
        ", as far as Ipopt can tell: the optimum is a local one, found from the quickest single swing" +
        std::string(limit.options.start.empty() ? "" : " or from the waveform of --start") +
        (model.empty() ? "." : ". A beam has more modes, by which a waveform can gain.") +
        " A beam whose modes still ring may bounce after a soft touch: the landing was simulated."});
  if (const std::string words = quasi_static_words(limit); !words.empty()) section.parts.emplace_back(Paragraph{words});
  return terminal_text({.headline = fmt::format("How quickly {} can close the switch{}", drives_of(limit.options.actuator), peak),
                        .doubt = limit.interrupted ? "Interrupted: what follows is not all." : "",
                        .sections = {std::move(section)}});
}

std::string limit_svg(const Limit& limit) {
  internal::Picture drawn;
  if (limit.landing) drawn = gap_and_drives(result_of(limit.landing->scene, limit.landing->closing, {}));
  add_curve(drawn.tables, "speed", limit.over_velocity, [](const LeastTime& l) { return l.permitted; });
  add_curve(drawn.tables, "peak", limit.over_peak, [](const LeastTime& l) { return l.peak; });
  if (drawn.tables.contains("peak")) {
    drawn.charts.push_back(curve("peak", "Least time against the peak voltage", "largest voltage", "V", drawn.tables.at("peak")));
  }
  if (drawn.tables.contains("speed")) {
    drawn.charts.push_back(curve("speed", "Least time against the permitted speed of the touch", "impact speed at most", "m/s",
                                 drawn.tables.at("speed")));
    drawn.charts.back().x_scale = internal::Scale::logarithmic;
  }
  const bool found = limit.touch.status == Status::done;
  const std::string model = model_of(limit);
  const std::string headline =
      found ? fmt::format("No waveform touches before {} at {} or less{}", quantity(limit.touch.time, "s", 4),
                          quantity(limit.impact_velocity, "m/s"), model.empty() ? "" : fmt::format(", with {}", model))
            : "The least time was not found: " + why_not(limit.touch);
  return svg_page(headline, limit.given.scene.title, drawn, 1);
}

}  // namespace softland
