#include "reports/devices_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "reports/closing_clauses.h"
#include "reports/escape.h"
#include "reports/figure_text.h"
#include "reports/page.h"
#include "reports/quantity.h"
#include "reports/robustness_words.h"
#include "reports/text.h"
#include "reports/text_table.h"

namespace softland {

const ResultDevices::Row* ResultDevices::row(std::string_view name) const {
  const auto found = std::ranges::find(rows, name, &Row::name);
  return found == rows.end() ? nullptr : &*found;
}

namespace {

using namespace internal;

constexpr double half = 0.5;

// What the table shows of 95 % of the devices.
struct Column {
  std::string_view key, heading, short_heading;
};
constexpr std::array columns{Column{key_of(&Metrics::largest_impact_velocity), "impact speed", "impact"},
                             Column{key_of(&Metrics::major_bounce_height), "highest rebound", "rebound"},
                             Column{key_of(&Metrics::initial_contact_time), "first contact", "contact"},
                             Column{key_of(&Metrics::peak_contact_force), "peak force", "force"},
                             Column{key_of(&Metrics::steady_force_time), "steady force from", "steady"}};

constexpr std::string_view steady_key = columns.back().key;

ResultDevices::Row row_of(const DevicesRow& row) {
  const DriveRobustness& drive = row.judged;
  ResultDevices::Row r{.name = row.name,
                       .pull_in_error = row.knowledge.pull_in_error.value_or(Metrics::unset),
                       .frequency_error = row.knowledge.frequency_error.value_or(Metrics::unset),
                       .piezo_error = row.knowledge.piezo_error.value_or(Metrics::unset),
                       .time_error = row.knowledge.time_error.value_or(Metrics::unset),
                       .searched_for_it = row.searched_for_it,
                       .bounce_free = drive.bounce_free.value,
                       .open = std::max(0.0, 1 - drive.closing.value - drive.collapsed.value),
                       .collapsed = drive.collapsed.value,
                       .at_95 = {}};
  for (const Figure& f : device_figures) {
    if (f.key != steady_key || row.judged_whole) r.at_95[std::string(f.key)] = drive.figures[f].quantiles[2].value;
  }
  return r;
}

std::string speed_of(const ResultDevices::Row& row) {
  const auto found = row.at_95.find(std::string(columns[0].key));
  return found == row.at_95.end() || !std::isfinite(found->second) ? std::string("∞") : quantity(found->second, "m/s");
}

std::string figure_name(std::string_view key) {
  std::string name(figure_of(key).name);
  if (!name.empty()) name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  return name;
}

// "impact speed 95 %"
std::vector<std::string> cells(const ResultDevices::Row& row) {
  std::vector<std::string> all{percent(row.bounce_free)};
  for (const Column& c : columns) {
    const auto found = row.at_95.find(std::string(c.key));
    const double value = found == row.at_95.end() ? Metrics::unset : found->second;
    all.push_back(std::isinf(value)                                              ? "∞"
                  : std::isnan(value)                                            ? "—"
                  : c.key == key_of(&Metrics::major_bounce_height) && value == 0 ? "none"
                                                                                 : quantity(value, figure_of(c.key).unit));
  }
  all.push_back(percent(std::max(0.0, row.open)));
  all.push_back(percent(row.collapsed));
  return all;
}

std::string front_words(const ResultDevices::FrontPoint& p) {
  return fmt::format("{}: touch within {} at up to {}, {} without a rebound", p.candidate, quantity(p.first_touch, "s"),
                     quantity(p.impact_speed, "m/s"), percent(p.bounce_free));
}

std::string known_words(const ResultDevices::ByError& known) {
  const std::string speed = std::isfinite(known.impact_speed) ? quantity(known.impact_speed, "m/s") : std::string("∞");
  return fmt::format("Vdp to {:g} %: {} land without a rebound, or 95 % touch at no more than {}", 100 * known.error,
                     percent(known.bounce_free), speed);
}

// Share without a rebound and impact speed over the error of Vdp.
std::string error_curve(const ResultDevices& d) {
  if (d.by_error.size() < 2) return {};
  CurveTables tables;
  CurveTable& table = tables["by-error"];
  for (const ResultDevices::ByError& known : d.by_error) {
    table["error"].push_back(100 * known.error);
    table["share"].push_back(100 * known.bounce_free);
    table["speed"].push_back(known.impact_speed);
  }
  const std::array ends{table["error"].front(), table["error"].back()};
  Chart share{
      .id = "share-by-error",
      .title = "Without a rebound, by the error of Vdp",
      .caption =
          "Devices that land without a rebound where Vdp is measured on each with this error, by the waveform that lands most.",
      .x_column = "error",
      .x_label = "Error of Vdp",
      .x_unit = "%",
      .y_label = "Devices",
      .y_unit = "%",
      .x_scale = Scale::logarithmic,
      .x_home = ends,
      .x_whole = ends,
      .y_home = std::array{0.0, 100.0},
      .height = 200,
      .series = {{.table = "by-error", .column = "share", .label = "", .role = Role::best}}};
  Chart speed = share;
  speed.id = "speed-by-error";
  speed.title = "Impact speed, by the error of Vdp";
  speed.caption =
      "95 % of the devices touch at no more than this where Vdp is measured on each with this error, by the softest waveform.";
  speed.y_label = "Impact speed";
  speed.y_unit = "m/s";
  speed.y_home.reset();
  speed.series.front().column = "speed";
  return "<div class=\"multiples\">\n" + small_picture(tables, share) + small_picture(tables, speed) + "</div>\n";
}

}  // namespace

ResultDevices devices_of(const ForDevicesResult& found, const OptimizeOptions& options, std::string next_command) {
  ResultDevices d{.spread_assumed = found.spread_assumed,
                  .spread = {},
                  .count = static_cast<double>(found.verdict.devices),
                  .seed = static_cast<double>(options.seed),
                  .closings = static_cast<double>(found.closings),
                  .measure = found.chosen ? found.chosen->measure : "",
                  .waveform = found.chosen ? found.chosen->family : "",
                  .better_than_plain_step = !found.plain_step_wins,
                  .worse_in = {},
                  .drawing = found.drawing.best ? FigureValues(found.drawing.best->metrics) : FigureValues(),
                  .drawing_status = found.drawing.best ? std::string(to_string(found.drawing.best->metrics.status)) : "",
                  .drawing_goal_met = found.drawing.goal_met,
                  .measured = found.calibrated_row,
                  .next_command = std::move(next_command)};
  d.spread = spread_words(found.varied.scene.spread);
  d.windows = found.windows;
  for (const std::string_view key : found.worse_in) d.worse_in.emplace_back(key);
  for (const DevicesRow& row : found.rows) d.rows.push_back(row_of(row));
  for (const FrontPoint& p : found.front)
    d.front.push_back({.first_touch = p.first_touch,
                       .impact_speed = p.impact_speed,
                       .bounce_free = p.bounce_free,
                       .candidate = fmt::format("{} by {}", p.waveform, p.measure)});
  for (const KnownVdp& known : found.by_error)
    d.by_error.push_back({.error = known.error, .bounce_free = known.bounce_free, .impact_speed = known.impact_speed});
  for (const ChosenFrom& one : found.candidates)
    d.race.push_back({.measure = one.measure,
                      .waveform = one.family,
                      .closings = static_cast<double>(one.closings),
                      .cost = one.tail,
                      .bounce_free = one.bounce_free});
  for (const FulfilledCondition& c : found.conditions)
    d.conditions.push_back({.text = c.condition.text,
                            .share = c.share.value,
                            .low = c.share.interval.low,
                            .high = c.share.interval.high,
                            .holds = c.holds});
  return d;
}

std::string internal::drawing_words(const ResultDevices& d) {
  const double closed = d.drawing[&Metrics::permanent_contact_time], height = d.drawing[&Metrics::major_bounce_height];
  if (d.drawing_goal_met && std::isfinite(closed))
    return fmt::format("The waveform for the drawing closes it without a rebound at {}: drawing.toml. ", quantity(closed, "s"));
  if (!std::isfinite(height)) return "No waveform was found that closes the drawing for good: drawing.toml. ";
  return fmt::format("The waveform for the drawing leaves rebounds of up to {}: drawing.toml. ", quantity(height, "m"));
}

std::string internal::devices_headline(const Result& result) {
  const ResultDevices& d = *result.devices;
  const ResultDevices::Row *step = d.row("plain step"), *own = d.row("for the devices"), *measured = d.row(d.measured);
  if (step == nullptr || own == nullptr) return {};
  const std::string assumed = d.spread_assumed ? " (assumed, the scene has no [spread]: " + d.spread + ")" : "";
  if (!d.better_than_plain_step) {
    std::string figures;
    for (const std::string& key : d.worse_in) figures += (figures.empty() ? "" : " and ") + figure_name(key);
    return fmt::format(
        "On devices that differ{}, no waveform that was found is as good as the plain step: the best is worse in its {}. "
        "best.toml is the plain step.",
        assumed, figures);
  }
  const std::string lands = own->bounce_free >= half ? fmt::format("{} land without a rebound (plain step {}), and 95 % touch",
                                                                   percent(own->bounce_free), percent(step->bounce_free))
                                                     : std::string("95 % touch");
  std::string words = fmt::format("Of {:.0f} devices that differ{}, {} at no more than {} instead of {}: best.toml.", d.count,
                                  assumed, lands, speed_of(*own), speed_of(*step));
  if (measured != nullptr && !d.next_command.empty()) {
    const char* const what = std::isfinite(measured->time_error) ? "one closing time measured to 50 ns" : "Vdp measured to 1 %";
    words +=
        measured->bounce_free >= half
            ? fmt::format(" With {} on each, {} land without a rebound: calibrated.toml.", what, percent(measured->bounce_free))
            : fmt::format(" With {} on each, 95 % touch at no more than {}: calibrated.toml.", what, speed_of(*measured));
  }
  return words;
}

std::string internal::devices_text(const ResultDevices& d) {
  if (d.rows.empty()) return {};
  std::vector<std::string> heads{"no rebound"};
  for (const Column& c : columns) heads.emplace_back(c.short_heading);
  heads.insert(heads.end(), {"stay open", "pulled in"});
  std::vector<TextColumn> shown = number_columns(heads, 11);
  shown.insert(shown.begin(), {.head = fmt::format("{:.0f} devices, 95 % below", d.count), .width = 26, .is_words = true});
  std::vector<internal::TextRow> rows;
  for (const ResultDevices::Row& row : d.rows) {
    rows.push_back(cells(row));
    rows.back().insert(rows.back().begin(), row.name);
  }
  std::string out = text_table(shown, rows);
  if (!d.measure.empty())
    out += "\n" +
           wrapped(fmt::format("best.toml is a {} waveform, searched by {}; {:.0f} closings in all. Devices: {}.", d.waveform,
                               d.measure == "drawing" ? "the nominal search" : d.measure, d.closings, d.spread)) +
           "\n";
  if (d.front.size() > 1) {
    out += "\nSooner or softer, of 95 % of the devices:\n";
    for (const ResultDevices::FrontPoint& p : d.front) out += "  " + front_words(p) + "\n";
  }
  if (!d.by_error.empty()) {
    out += "\nWhat a measured Vdp is worth, by its error, with one waveform or another:\n";
    for (const ResultDevices::ByError& known : d.by_error) out += "  " + known_words(known) + "\n";
  }
  if (const std::string held = window_words(d.windows); !held.empty()) out += "\n" + wrapped(held) + "\n";
  for (const ResultRobust::Condition& c : d.conditions)
    out += "\n" +
           wrapped(fmt::format("The condition {} {}: {} of the devices fulfil it.", c.text, c.holds ? "holds" : "does not hold",
                               percent(c.share))) +
           "\n";
  if (!d.next_command.empty()) out += "\nFor a device that was measured:\n  " + printable_line(d.next_command) + "\n";
  return out;
}

std::string internal::devices_keys(const ResultDevices& d) {
  const ResultDevices::Row *step = d.row("plain step"), *own = d.row("for the devices");
  if (step == nullptr || own == nullptr) return {};
  const std::vector<std::string> before = cells(*step), after = cells(*own);
  std::string out;
  const auto add = [&](const std::string& name, std::size_t column) {
    out += fmt::format(
        "<div class=\"key\"><dt>{}</dt><dd><span class=\"before\">{} <span aria-label=\"becomes\">→</span></span> <span "
        "class=\"after\">{}</span></dd></div>\n",
        name, escaped(before[column]), escaped(after[column]));
  };
  add("Devices without a rebound", 0);
  for (std::size_t i = 0; i < 3; ++i) add(capitalised(std::string(columns[i].heading)) + ", of 95 %", i + 1);
  return out;
}

std::string internal::devices_section(const ResultDevices& d) {
  if (d.rows.empty()) return {};
  TableRow head{"Waveform", "Without a rebound"};
  for (const Column& c : columns) head.emplace_back(capitalised(std::string(c.heading)));
  head.insert(head.end(), {"Stay open", "Pulled onto the electrode"});
  std::vector<TableRow> rows;
  for (const ResultDevices::Row& row : d.rows) {
    const bool is_measured = !std::isnan(row.pull_in_error) || !std::isnan(row.time_error);
    const std::string name = is_measured ? "with " + row.name : row.name;
    TableRow& cell = rows.emplace_back(TableRow{escaped(capitalised(name))});
    const bool is_own = row.name == "for the devices";
    for (const std::string& one : cells(row)) {
      if (is_own) {
        cell.emplace_back(escaped(one), "own");
      } else {
        cell.emplace_back(escaped(one));
      }
    }
  }
  std::string body =
      fmt::format("<p>{:.0f} fresh devices: {}.{} Figures are those that 95 % of the devices stay below.</p>\n", d.count,
                  escaped(d.spread), d.spread_assumed ? " The scene has no [spread]: this one is assumed." : "");
  body += table_html(head, rows);
  if (d.front.size() > 1) {
    body += "<p class=\"below\">Sooner or softer: what 95 % of the devices reach with the other candidates.</p>\n<ul>\n";
    for (const ResultDevices::FrontPoint& p : d.front) body += "<li>" + escaped(front_words(p)) + "</li>\n";
    body += "</ul>\n";
  }
  body += error_curve(d);
  if (const std::string held = window_words(d.windows); !held.empty()) body += "<p class=\"below\">" + escaped(held) + "</p>\n";
  if (!d.next_command.empty())
    body += fmt::format("<p class=\"below\">For a device that was measured: <code>{}</code></p>\n", escaped(d.next_command));
  body += "<p>More: <a href=\"robustness.html\">how the devices do</a>, device by device and figure by figure.</p>\n";
  return section("devices", "On devices that differ", body);
}

}  // namespace softland
