#include "reports/limit_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "document/chart.h"
#include "document/csv_cell.h"
#include "document/document.h"
#include "document/quantity.h"
#include "document/svg.h"
#include "reports/closing_charts.h"
#include "reports/closing_record.h"
#include "reports/record_file.h"
#include "reports/study_members.h"
#include "studies/closing/summits_at_hold.h"

namespace softland {
namespace {

using internal::quantity;
using nlohmann::json;

std::string drives_of(Actuator actuator) {
  switch (actuator) {
    case Actuator::electrostatic:
      return "the electrodes";
    case Actuator::pzt:
      return "the piezo";
    case Actuator::both:
      break;
  }
  return "the electrodes and the piezo";
}

std::string why_not(const LeastTime& least) {
  return least.message.empty() ? std::string(to_string(least.status)) : least.message;
}

TableRow least_row(const std::string& name, const LeastTime& least) {
  if (least.status != Status::done) return {name, "—", "—", why_not(least)};
  return {name, quantity(least.time, "s", 4), quantity(least.impact_velocity, "m/s"),
          least.from_start ? "found from the waveform of --start" : ""};
}

// Returns a table of the least closing times of any waveform, with a row per value of a limit, such as the peak voltage; `name`
// formats this value.
template <class Name>
ReportTable list_table(const char* title, const std::vector<LeastTime>& all, Name name) {
  ReportTable table{.head = {title, "least time", {"", "words"}}, .rows = {}};
  for (const LeastTime& least : all) {
    const bool done = least.status == Status::done;
    table.rows.push_back({name(least), done ? quantity(least.time, "s", 4) : "—", done ? "" : why_not(least)});
  }
  return table;
}

// Names the model for which the least closing time is a bound: a beam with more modes may close earlier. Empty for a rigid
// plate, which has one mode.
std::string model_of(const LimitRecord& limit) {
  if (read_drawn_scene(limit.origin.scene).structure == SideOfStructure::on_springs) return {};
  return fmt::format("{} mode{}", limit.modes, limit.modes == 1 ? "" : "s");
}

// Describes the motion of the switch after its first contact under the waveform of least closing time.
std::string words_after(const LimitRecord::Landing& landing) {
  if (landing.bounce_free) return "bounce-free, confirmed";
  const Metrics& own = landing.metrics;
  std::string words =
      own.major_bounce_height > 0 ? fmt::format("rebounds by up to {}", quantity(own.major_bounce_height, "m")) : "bounce-free";
  std::string others;
  for (const LimitRecord::Check& c : landing.checks) {
    if (c.metrics.bounce_count == 0 && c.metrics.status == Status::done) continue;
    const std::string course = c.metrics.bounce_count > 0 ? "it rebounds by up to " + quantity(c.metrics.major_bounce_height, "m")
                                                          : std::string("it does not settle");
    others += fmt::format("{} {} {}", others.empty() ? ", but with" : ",", c.name, course);
  }
  words += others;
  return words;
}

std::string words_of_catch(const LimitRecord::Landing& landing, double permitted) {
  constexpr double same = 1.5;  // largest ratio of the simulated impact velocity to the permitted one that needs no word
  const double pulled = landing.catch_time - landing.catch_delay, ratio = landing.metrics.impact_velocity / permitted;
  std::string words = "landing";
  if (pulled > 0) {
    words += fmt::format(" with a pulse of {}", quantity(pulled, "s"));
    words += landing.catch_delay > 0 ? fmt::format(", {} after the touch", quantity(landing.catch_delay, "s")) : " at the touch";
  }
  return ratio > same ? fmt::format("{}, at {:.0f} times the permitted velocity", words, ratio) : words;
}

ReportTable touches_table(const LimitRecord& limit) {
  ReportTable table{.head = {"", "first touch", "impact velocity", {"", "words"}}, .rows = {}};
  table.rows = {
      {"plain step", quantity(limit.step.initial_contact_time, "s", 4), quantity(limit.step.impact_velocity, "m/s")},
      least_row(fmt::format("least time, impact velocity at most {}", quantity(limit.impact_velocity, "m/s")), limit.touch),
      least_row("least time, every mode at rest", limit.rest)};
  if (limit.landing) {
    const Metrics& m = limit.landing->metrics;
    table.rows.push_back({words_of_catch(*limit.landing, limit.impact_velocity), quantity(m.initial_contact_time, "s", 4),
                          quantity(m.impact_velocity, "m/s"), words_after(*limit.landing)});
  }
  return table;
}

// Adds the curve of the least closing time over a limit, such as the peak voltage, as the columns "x" and "time" of a table.
// x(least) returns the value of the limit. A value without a result is left out.
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
  constexpr double beside = 0.1;  // half width of the x axis around a curve of a single point, as a share of its x
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

// States the lowest impact velocity at which one slow (quasi-static) waveform closes all varied devices.
std::string quasi_static_prose(const LimitRecord& limit) {
  if (!limit.quasi_static || !std::isfinite(limit.quasi_static->speed)) return {};
  const auto& [name, touch_places, steady, speed] = *limit.quasi_static;
  const std::string drive = name == piezo_drive ? "piezo" : "electrode " + name;
  return fmt::format(
      "The {} can move the devices of [spread] to their contact slowly, through stable equilibria. The positions at which 90 % "
      "of them touch extend over {}. A waveform that crosses this range at constant speed, and is steady as soon as the plain "
      "step (at {}), has an impact velocity of at least {}.",
      drive, quantity(touch_places, "m"), quantity(steady, "s"), quantity(speed, "m/s"));
}

// Names the optimum for which an attempt searched.
std::string words_of(const LimitAttempt& attempt) {
  const LeastTime& own = attempt.found;
  std::string words = attempt.goal == LimitGoal::rest ? "every mode at rest" : "touch at up to " + quantity(own.permitted, "m/s");
  if (attempt.goal == LimitGoal::over_peak) words += " with up to " + quantity(own.peak, "V", 4);
  return words + (own.from_start ? ", from the waveform of --start" : "");
}

// Adds how many optima were found, and a line for each search that failed. The tables say what the drives cannot reach.
void add_attempts(ReportSection& section, const std::vector<LimitAttempt>& attempts) {
  if (attempts.empty()) return;
  long optima = 0, found = 0, iterations = 0;
  ReportList failed;
  for (const LimitAttempt& attempt : attempts) {
    const LeastTime& own = attempt.found;
    if (!own.from_start) ++optima;
    if (attempt.accepted) ++found;
    iterations += own.iterations;
    if (own.status != Status::numerical_failure) continue;
    failed.lines.push_back(fmt::format("Not found: {}: {} (stage: {}, {} iterations)", words_of(attempt), why_not(own),
                                       name_of(search_stages, own.stage), own.iterations));
  }
  section.parts.emplace_back(Paragraph{fmt::format("{} of {} optima found, {} iterations of Ipopt.", found, optima, iterations)});
  if (!failed.lines.empty()) section.parts.emplace_back(std::move(failed));
}

}  // namespace

void members(internal::Archive& a, LeastTime& least) {
  a("status", least.status, "outcome of the search for the least time");
  a("message", least.message, "why it is not done");
  a("from_start", least.from_start, "whether it was found from the given waveform");
  a("least_time_s", least.time, "least time until the first contact");
  a(key_of(&Metrics::impact_velocity), least.impact_velocity, "speed of the contact point at the first contact");
  a("permitted_impact_velocity_m_s", least.permitted, "largest permitted speed");
  a("peak_voltage_V", least.peak, "permitted voltage of the electrode");
  a("simulated_time_s", least.simulated_time, "time of the first contact in a simulation");
  a("simulated_impact_velocity_m_s", least.simulated_velocity, "speed of the first contact in a simulation");
  a("distance_from_rest", least.distance, "largest difference of a mode from its closed equilibrium, in contact gaps");
}

void members(internal::Archive& a, LimitAttempt& attempt) {
  a("goal", internal::Chosen{attempt.goal, limit_goals}, "what the least time is computed for");
  a("accepted", attempt.accepted, "whether it found the optimum that is reported");
  a("stage", internal::Chosen{attempt.found.stage, search_stages}, "part of the search that began last");
  a("iterations", attempt.found.iterations, "iterations of Ipopt");
  members(a, attempt.found);
}

void members(internal::Archive& a, LimitRecord::QuasiStatic& found) {
  a("drive", found.drive, "drive of the slow waveform");
  a("touch_places_m", found.touch_places, "width of the range of positions at which 90 % of the devices touch");
  a("steady_s", found.steady, "time from which the force is steady under the plain step");
  a("speed_m_s", found.speed, "least impact velocity of such a waveform");
}

void members(internal::Archive& a, LimitRecord::Check& check) {
  a("name", check.name, "what differs in the repeated simulation");
  a("metrics", check.metrics, "its figures");
}

void members(internal::Archive& a, LimitRecord::Landing& landing) {
  a("way", landing.path, "least time of this landing");
  a("at_rest", landing.at_rest, "whether all modes end at rest");
  a("catch_delay_s", landing.catch_delay, "time from first contact to the pull that keeps the switch closed");
  a("catch_s", landing.catch_time, "time from first contact to the hold levels");
  a("bounce_free", landing.bounce_free, "whether the closing is bounce-free");
  a("metrics", landing.metrics, "figures of the closing");
  a("confirmed_by", landing.checks, "repeated simulations");
  a("scene", landing.scene, "scene with its waveforms");
}

void members(internal::Archive& a, LimitRecord& limit) {
  members(a, limit.origin);
  a("status", limit.status, "outcome of the search for the least time, or `interrupted`");
  a("actuator", internal::Chosen{limit.actuator, actuators}, "controlled drives");
  a("permitted_impact_velocity_m_s", limit.impact_velocity, "largest permitted impact velocity");
  a("modes", limit.modes, "number of modes");
  a("has_start", limit.has_start, "whether the search started from a given waveform");
  a("plain_step", limit.step, "figures of the plain step");
  a("touch", limit.touch, "least time to touch at the permitted velocity");
  a("at_rest", limit.rest, "least time to touch with all modes at rest");
  a("quasi_static", internal::OrNull{limit.quasi_static}, "least impact velocity of a slow waveform");
  a("closed_state", limit.closed_state, "closed equilibrium under the hold levels");
  a("hold_warning", internal::OrNull{limit.hold_warning}, "warning that the hold levels do not keep the switch closed");
  a("warnings", limit.warnings, "warnings");
  a("landing", internal::OrNull{limit.landing}, "closing of the least time that lands");
  a("over_impact_velocity", limit.over_velocity, "least time over the permitted velocity");
  a("over_peak_voltage", limit.over_peak, "least time over the permitted voltage");
  a("attempts", limit.attempts, "log: every search for a least time, in the order of the work");
  if (!a.has(limit.landed.has_value())) return;
  a.object(
      "curves",
      [&](auto& curves) {
        curves.custom(
            "landing", limit.landed, [](const auto& run) { return json_of(*run); },
            [](const json& run) { return std::optional(read_closing(run)); },
            internal::Written{"record of [simulate](#simulate)", "the closing that lands"});
      },
      "curves of the run, in files only");
}

LimitRecord record_of(const Limit& limit, const std::string& command) {
  LimitRecord record{.origin = origin_of("limit", limit.given, command),
                     .status = std::string(limit.interrupted ? "interrupted" : to_string(limit.touch.status)),
                     .actuator = limit.options.actuator,
                     .impact_velocity = limit.impact_velocity,
                     .modes = static_cast<int>(limit.given.model.modes()),
                     .has_start = !limit.options.start.empty(),
                     .step = limit.step,
                     .touch = limit.touch,
                     .rest = limit.rest,
                     .quasi_static = {},
                     .closed_state = limit.closed_state,
                     .hold_warning = limit.hold_warning,
                     .warnings = limit.given.scene.warnings,
                     .landing = {},
                     .over_velocity = limit.over_velocity,
                     .over_peak = limit.over_peak,
                     .attempts = limit.attempts,
                     .landed = {}};
  if (limit.approach)
    record.quasi_static = {limit.approach->drive, limit.approach->touch_places(), limit.step.steady_force_time,
                           limit.quasi_static};
  if (!limit.hold_warning.empty()) record.warnings.push_back(limit.hold_warning);
  if (std::string few = few_summits_warning(limit.given.model, limit.given.signals()); !few.empty())
    record.warnings.push_back(std::move(few));
  if (const auto& found = limit.landing) {
    record.landed = record_of(found->scene, found->closing, {});
    record.landing = {found->path,
                      std::isfinite(found->path.distance),
                      found->catch_delay,
                      found->catch_time,
                      found->bounce_free,
                      found->closing.metrics,
                      {},
                      found->scene.scene.file.json()};
    for (const CheckingRun& c : found->checks) {
      if (c.varied != Varied::gas) record.landing->checks.push_back({c.name, c.metrics});
    }
  }
  return record;
}

json json_of(const LimitRecord& record) { return internal::record_json(record); }

LimitRecord read_limit(const json& from) { return internal::whole_record<LimitRecord>(from); }

std::string text_of(const LimitRecord& limit) {
  const std::string peak = std::isfinite(limit.touch.peak) ? fmt::format(", up to {}", quantity(limit.touch.peak, "V")) : "";
  ReportSection section{.id = "least-times", .heading = "Least times", .parts = {}};
  if (!limit.hold_warning.empty()) section.parts.emplace_back(Paragraph{"warning: " + limit.hold_warning});
  section.parts.emplace_back(touches_table(limit));
  if (!limit.over_velocity.empty())
    section.parts.emplace_back(list_table("impact velocity up to", limit.over_velocity,
                                          [](const LeastTime& l) { return quantity(l.permitted, "m/s"); }));
  if (!limit.over_peak.empty())
    section.parts.emplace_back(
        list_table("voltage up to", limit.over_peak, [](const LeastTime& l) { return quantity(l.peak, "V", 4); }));
  add_attempts(section, limit.attempts);
  const std::string model = model_of(limit);
  if (limit.touch.status == Status::done || limit.rest.status == Status::done)
    section.parts.emplace_back(
        Paragraph{"Ipopt found no waveform of these drives that touches earlier at that impact velocity" +
                  (model.empty() ? "" : " in this model of " + model) +
                  ". The optimum is a local one: the search began with the fastest single swing" +
                  std::string(!limit.has_start ? "" : " or with the waveform of --start") +
                  (model.empty() ? "." : ". A beam has more modes, which may allow a faster waveform.") +
                  " A beam whose modes still vibrate may bounce after a soft touch, so the landing was simulated."});
  if (const std::string words = quasi_static_prose(limit); !words.empty()) section.parts.emplace_back(Paragraph{words});
  return terminal_text(
      {.headline = fmt::format("Least times in which {} can close the switch{}", drives_of(limit.actuator), peak),
       .doubt = limit.status == "interrupted" ? "Interrupted: the results are incomplete." : "",
       .sections = {std::move(section)}});
}

std::string attempts_csv(const LimitRecord& limit) {
  using internal::csv_cell;
  std::string text =
      "goal,from_start,permitted_impact_velocity_m_s,peak_voltage_V,accepted,status,stage,message,iterations,least_time_s,"
      "impact_velocity_m_s,simulated_time_s,simulated_impact_velocity_m_s,distance_from_rest\n";
  for (const LimitAttempt& attempt : limit.attempts) {
    const LeastTime& own = attempt.found;
    text += fmt::format("{},{},{},{},{},{},{},{},{}", name_of(limit_goals, attempt.goal), own.from_start, csv_cell(own.permitted),
                        csv_cell(own.peak), attempt.accepted, to_string(own.status), name_of(search_stages, own.stage),
                        csv_cell(own.message), own.iterations);
    for (const double value : {own.time, own.impact_velocity, own.simulated_time, own.simulated_velocity, own.distance})
      text += "," + csv_cell(value);
    text += "\n";
  }
  return text;
}

std::string svg_of(const LimitRecord& limit) {
  internal::Picture drawn;
  if (limit.landed) drawn = gap_and_drives(*limit.landed);
  add_curve(drawn.tables, "speed", limit.over_velocity, [](const LeastTime& l) { return l.permitted; });
  add_curve(drawn.tables, "peak", limit.over_peak, [](const LeastTime& l) { return l.peak; });
  if (drawn.tables.contains("peak")) {
    drawn.charts.push_back(curve("peak", "Least time against the peak voltage", "largest voltage", "V", drawn.tables.at("peak")));
  }
  if (drawn.tables.contains("speed")) {
    drawn.charts.push_back(curve("speed", "Least time against the permitted impact velocity", "permitted impact velocity", "m/s",
                                 drawn.tables.at("speed")));
    drawn.charts.back().x_scale = internal::AxisScale::logarithmic;
  }
  const bool found = limit.touch.status == Status::done;
  const std::string model = model_of(limit);
  std::string headline = found ? fmt::format("The fastest waveform that was found touches after {} at {} or less{}",
                                             quantity(limit.touch.time, "s", 4), quantity(limit.impact_velocity, "m/s"),
                                             model.empty() ? "" : fmt::format(", with {}", model))
                               : "The least time was not found: " + why_not(limit.touch);
  if (limit.landing) {
    const Metrics& drawn_run = limit.landing->metrics;
    headline += fmt::format(". The closing that is drawn lands after {} at {}", quantity(drawn_run.initial_contact_time, "s", 4),
                            quantity(drawn_run.impact_velocity, "m/s"));
  }
  return svg_page(headline, title_of(limit.origin), drawn, 1);
}

}  // namespace softland
