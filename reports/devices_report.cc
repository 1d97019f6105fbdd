#include "reports/devices_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>
#include <vector>

#include "reports/closing_words.h"
#include "reports/escape.h"
#include "reports/figure_text.h"
#include "reports/page.h"
#include "reports/quantity.h"
#include "reports/robustness_words.h"

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

// On a page there is room for more words.
TableCell headed(std::string_view on_terminal, std::string_view on_page) {
  TableCell cell(on_terminal);
  cell.html = escaped(capitalised(std::string(on_page)));
  return cell;
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

std::vector<KeyNumber> internal::devices_keys(const ResultDevices& d) {
  const ResultDevices::Row *step = d.row("plain step"), *own = d.row("for the devices");
  if (step == nullptr || own == nullptr) return {};
  const std::vector<std::string> before = cells(*step), after = cells(*own);
  std::vector<KeyNumber> keys{{.name = "Devices without a rebound", .value = after[0], .before = before[0]}};
  for (std::size_t i = 1; i <= 3; ++i)
    keys.push_back(
        {.name = capitalised(std::string(columns[i - 1].heading)) + ", of 95 %", .value = after[i], .before = before[i]});
  return keys;
}

namespace {

ReportTable devices_table(const ResultDevices& d) {
  ReportTable table{.head = {fmt::format("{:.0f} devices, 95 % below", d.count), headed("no rebound", "without a rebound")},
                    .rows = {}};
  for (const Column& c : columns) table.head.push_back(headed(c.short_heading, c.heading));
  table.head.push_back(headed("stay open", "stay open"));
  table.head.push_back(headed("pulled in", "pulled onto the electrode"));
  for (const ResultDevices::Row& row : d.rows) {
    TableRow& line = table.rows.emplace_back(TableRow{row.name});
    for (const std::string& one : cells(row)) line.emplace_back(one, row.name == "for the devices" ? "own" : "");
  }
  return table;
}

}  // namespace

ReportSection internal::devices_section(const ResultDevices& d) {
  ReportSection section{.id = "devices", .heading = "On devices that differ", .parts = {}};
  if (d.rows.empty()) return section;
  const auto note = [&](std::string text) { section.parts.emplace_back(Paragraph{.text = std::move(text), .is_note = true}); };
  section.parts.emplace_back(devices_table(d));
  if (!d.measure.empty())
    note(fmt::format("best.toml is a {} waveform, searched by {}; {:.0f} closings in all. Devices: {}.{}", d.waveform,
                     d.measure == "drawing" ? "the nominal search" : d.measure, d.closings, d.spread,
                     d.spread_assumed ? " The scene has no [spread]: this one is assumed." : ""));
  const auto list = [&](const char* head, const auto& all, const auto& words) {
    section.parts.emplace_back(SubHeading{head});
    ReportList lines;
    for (const auto& one : all) lines.lines.push_back(words(one));
    section.parts.emplace_back(std::move(lines));
  };
  if (d.front.size() > 1) list("Sooner or softer, of 95 % of the devices", d.front, front_words);
  if (!d.by_error.empty())
    list("What a measured Vdp is worth, by its error, with one waveform or another", d.by_error, known_words);
  section.parts.emplace_back(Drawing{[&d](const Picture&) { return error_curve(d); }});
  note(window_words(d.windows));
  for (const ResultRobust::Condition& c : d.conditions)
    note(fmt::format("The condition {} {}: {} of the devices fulfil it.", c.text, c.holds ? "holds" : "does not hold",
                     percent(c.share)));
  if (!d.next_command.empty()) {
    section.parts.emplace_back(SubHeading{"For a device that was measured"});
    section.parts.emplace_back(ReportList{{d.next_command}});
  }
  section.parts.emplace_back(
      drawing_of("<p class=\"below\">More: <a href=\"robustness.html\">how the devices do</a>, device by device and figure by "
                 "figure.</p>\n"));
  return section;
}

}  // namespace softland
