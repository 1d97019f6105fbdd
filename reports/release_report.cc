#include "reports/release_report.h"

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
#include "reports/robustness_words.h"
#include "reports/svg.h"
#include "studies/closing/summits_at_hold.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using internal::json_number;
using internal::percent;
using internal::quantity;
using internal::spread_words;
using nlohmann::json;

constexpr const char* plain_words = "plain opening";
constexpr double curve_tolerance = 1e-4;  // of the largest voltage, where a drive is no straight line

json figures_json(const OpeningFigures& f) {
  return {{"status", to_string(f.status)},
          {"release_time_s", json_number(f.release_time)},
          {"settling_time_s", json_number(f.settling_time)},
          {"overshoot_m", json_number(f.overshoot)},
          {"residual_vibration_m", json_number(f.residual_vibration)},
          {"touches_again", f.touches}};
}

// Drives that are voltages, with their signals.
std::map<std::string, Signal> voltages(const OpeningResult& r, const Opening& o) {
  std::map<std::string, Signal> all;
  const std::vector<std::string> names = r.given.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] != dispersion_drive) all.emplace(names[k], o.signals[k]);
  }
  return all;
}

double hold_of(const OpeningResult& r, const std::string& drive) {
  const std::vector<std::string> names = r.given.drive_names();
  return r.holds[static_cast<std::size_t>(std::find(names.begin(), names.end(), drive) - names.begin())];
}

// A drive from its hold level on.
std::vector<std::pair<double, double>> line_of(const OpeningResult& r, const std::string& drive, const Signal& signal,
                                               double end) {
  const double hold = hold_of(r, drive);
  const double size = std::max({std::abs(hold), signal.peak(), 1e-9});
  std::vector<std::pair<double, double>> points = polyline(signal, end, curve_tolerance * size, 0);
  if (points.size() > 1 && points[0].first == 0 && points[1].first == 0)
    points.erase(points.begin());  // from 0 V, which it was not at
  if (points.front().second != hold) points.insert(points.begin(), {0, hold});
  return points;
}

json opening_json(const OpeningResult& r, const Opening& o) {
  json waveforms = json::object();
  for (const auto& [drive, signal] : voltages(r, o)) {
    json points = json::array();
    for (const auto& [time, voltage] : line_of(r, drive, signal, o.voltages_end)) points.push_back({time, voltage});
    waveforms[drive] = points;
  }
  return {{"figures", figures_json(o.figures)},
          {"message", o.trajectory.message},
          {"drives_end_s", json_number(o.voltages_end)},
          {"waveforms", waveforms}};
}

std::string gain(double plain, double best) {
  if (!(plain > 0) || !(best > 0) || !std::isfinite(plain) || best >= plain) return {};
  return internal::times(plain / best) + " less";
}

TableRow quantity_row(const OpeningResult& r, const std::string& name, double OpeningFigures::*member, std::string_view unit,
                      bool lower) {
  const double plain = r.plain.figures.*member;
  if (!r.best) return {name, quantity(plain, unit)};
  const double best = r.best->figures.*member;
  return {name, quantity(plain, unit), quantity(best, unit), lower ? gain(plain, best) : ""};
}

std::string finding(const OpeningResult& r) {
  const OpeningFigures& plain = r.plain.figures;
  const auto ends = [](const OpeningFigures& f) {
    if (!std::isfinite(f.release_time)) return std::string("stays closed");
    return std::isfinite(f.settling_time) ? fmt::format("is open for good after {}", quantity(f.settling_time, "s"))
                                          : std::string("still swings at the end of the window");
  };
  std::string words = fmt::format("Dropped to 0 V at once the switch {}", ends(plain));
  if (r.best) words += fmt::format("; braked it {}", ends(r.best->figures));
  return words + ".";
}

// Where the figures are from, what confirms them.
std::string remarks(const OpeningResult& r) {
  std::string words = fmt::format(
      "Open for good: the contact point stays within {} of its open position ({} of the contact gap). Residual vibration: how "
      "far it "
      "still swings from there once all drives stand at 0 V.",
      quantity(r.band, "m"), percent(r.options.band));
  if (!r.best) return words + " No waveform was found that opens the switch.";
  words += fmt::format(" Searched: {} waveforms, seed {}.", r.search.evaluations, r.options.seed);
  for (const ConfirmingOpening& c : r.checks) {
    words += fmt::format(" With {}: {}.", c.name,
                         std::isfinite(c.figures.residual_vibration)
                             ? "residual vibration " + quantity(c.figures.residual_vibration, "m")
                             : std::string(to_string(c.figures.status)));
  }
  return words;
}

internal::CurveTable gap_table(const OpeningResult& r, const Opening& o) {
  internal::CurveTable table;
  const ResultCurve curve = curve_of(o.trajectory, r.given.scene.metrics);
  table["time_s"] = curve.time;
  table["tip_gap_m"] = curve.gap;
  return table;
}

internal::Chart over_time(const std::string& id, const std::string& title, const char* y_label, const char* y_unit,
                          double until) {
  internal::Chart chart{
      .id = id, .title = title, .x_column = "time_s", .x_label = "Time", .x_unit = "s", .y_label = y_label, .y_unit = y_unit};
  chart.x_home = chart.x_whole = {0, until};
  return chart;
}

// Until the braked switch is quiet and a little longer.
double shown_until(const OpeningResult& r, double window) {
  constexpr double longer = 3;
  if (!r.best) return window;
  const double end = std::fmax(r.best->voltages_end, r.best->figures.settling_time);
  return std::min(window, longer * end);
}

}  // namespace

namespace {

json openings_json(const DeviceOpenings& o) {
  return {{"open", json_number(o.open)},
          {"in_band_with_drives", json_number(o.in_band)},
          {"settling_time_s", json_number(o.settling_time)},
          {"residual_vibration_m", json_number(o.residual_vibration)},
          {"overshoot_m", json_number(o.overshoot)}};
}

json devices_json(const std::optional<OpeningsOnDevices>& found) {
  if (!found) return nullptr;
  return {{"count", found->devices},
          {"spread_assumed", found->spread_assumed},
          {"spread", spread_words(found->spread)},
          {"plain", openings_json(found->plain)},
          {"best", openings_json(found->best)}};
}

// What 95 % of the devices do under either opening.
ReportSection devices_section(const OpeningsOnDevices& found) {
  ReportTable table{.head = {"", plain_words, "found"}, .rows = {}};
  table.rows = {{"open for good", percent(found.plain.open), percent(found.best.open)},
                {"from when the drives stand on", percent(found.plain.in_band), percent(found.best.in_band)}};
  const auto add = [&](const char* name, double DeviceOpenings::*figure, const char* unit) {
    const auto value = [&](double v) { return std::isfinite(v) ? quantity(v, unit) : std::string("∞"); };
    table.rows.push_back({name, value(found.plain.*figure), value(found.best.*figure)});
  };
  add("open for good, 95 % within", &DeviceOpenings::settling_time, "s");
  add("residual vibration, 95 % below", &DeviceOpenings::residual_vibration, "m");
  add("beyond the open position, 95 % below", &DeviceOpenings::overshoot, "m");
  return {.id = "devices",
          .heading = "On devices that differ",
          .parts = {Paragraph{fmt::format("On {} devices, all in the volts of the nominal one: {}{}.", found.devices,
                                          spread_words(found.spread),
                                          found.spread_assumed ? " (assumed, the scene has no [spread])" : "")},
                    std::move(table)}};
}

ReportTable openings_table(const OpeningResult& r) {
  ReportTable table{.head = {"", plain_words, r.best ? "found" : "", {"", "words"}}, .rows = {}};
  table.rows = {
      quantity_row(r, "leaves its contact", &OpeningFigures::release_time, "s", false),
      quantity_row(r, "open for good", &OpeningFigures::settling_time, "s", true),
      quantity_row(r, "residual vibration", &OpeningFigures::residual_vibration, "m", true),
      quantity_row(r, "furthest beyond its open position", &OpeningFigures::overshoot, "m", true),
      {"touches again", std::to_string(r.plain.figures.touches), r.best ? std::to_string(r.best->figures.touches) : ""}};
  return table;
}

ReportTable parameters_table(const OpeningResult& r) {
  ReportTable table{.head = {"parameter", "value"}, .rows = {}};
  for (const auto& [name, value] : r.parameters)
    table.rows.push_back({name, quantity(value, name.find(".level_") == std::string::npos ? "s" : "V", 4)});
  return table;
}

}  // namespace

std::vector<std::string> warnings(const OpeningResult& r) {
  std::vector<std::string> all = r.given.scene.warnings;
  if (std::string few = few_summits_warning(r.given.model, r.given.signals()); !few.empty()) all.push_back(std::move(few));
  return all;
}

json release_json(const OpeningResult& r, const Provenance& provenance) {
  json checks = json::array();
  for (const ConfirmingOpening& c : r.checks) checks.push_back({{"name", c.name}, {"figures", figures_json(c.figures)}});
  json holds = json::object();
  const std::vector<std::string> names = r.given.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) holds[names[k]] = json_number(r.holds[k]);
  return with_origin({{"kind", "release"},
                      {"status", r.interrupted ? "interrupted" : to_string((r.best ? *r.best : r.plain).trajectory.status)},
                      {"actuator", name_of(actuators, r.options.actuator)},
                      {"hold_levels", holds},
                      {"contact_force_N", json_number(r.contact_force)},
                      {"open_position_m", json_number(r.open_position)},
                      {"band_m", json_number(r.band)},
                      {"plain", opening_json(r, r.plain)},
                      {"best", r.best ? opening_json(r, *r.best) : json()},
                      {"parameters", r.parameters},
                      {"confirmed_by", checks},
                      {"devices", devices_json(r.on_devices)},
                      {"goal_met", r.goal_met},
                      {"confirmed", r.confirmed},
                      {"evaluations", r.search.evaluations},
                      {"seed", r.options.seed},
                      {"termination", to_string(r.search.termination)},
                      {"warnings", warnings(r)}},
                     r.given, provenance.command);
}

std::string release_text(const OpeningResult& r) {
  ReportSection opening{.id = "opening", .heading = "The opening", .parts = {openings_table(r)}};
  if (r.best) opening.parts.emplace_back(parameters_table(r));
  Document document{.headline = finding(r),
                    .doubt = r.interrupted ? "Interrupted: what follows is the best so far." : "",
                    .sections = {std::move(opening)},
                    .warnings = warnings(r)};
  if (r.on_devices) document.sections.push_back(devices_section(*r.on_devices));
  document.sections.push_back({.id = "remarks", .heading = "Remarks", .parts = {Paragraph{remarks(r)}}});
  return terminal_text(document);
}

std::string release_svg(const OpeningResult& r) {
  const double window = r.plain.trajectory.points.empty() ? r.window : r.plain.trajectory.points.back().time;
  const double shown = shown_until(r, window);
  struct Drawn {
    const Opening* opening;
    const char *name, *words;
    internal::Role role;
  };
  std::vector<Drawn> runs{{&r.plain, "plain", plain_words, internal::Role::baseline}};
  if (r.best) runs.push_back({&*r.best, "best", "found", internal::Role::best});
  internal::Picture drawn;
  internal::Chart gap = over_time("gap", "Gap: the opening", "Gap", "m", shown);
  gap.zero_line = true;
  gap.zero_label = "contact plane";
  gap.height = 320;
  for (const Drawn& run : runs) {
    drawn.tables[run.name] = gap_table(r, *run.opening);
    gap.series.push_back({run.name, "tip_gap_m", run.words, run.role});
  }
  drawn.charts.push_back(gap);
  for (const Drawn& run : runs) {
    std::size_t place = 1;  // of the drive's chart
    for (const auto& [drive, signal] : voltages(r, *run.opening)) {
      const std::string table = fmt::format("{}/{}", run.name, drive);
      for (const auto& [time, voltage] : line_of(r, drive, signal, std::max(shown, run.opening->voltages_end))) {
        drawn.tables[table]["time_s"].push_back(time);
        drawn.tables[table]["level"].push_back(voltage);
      }
      if (drawn.charts.size() == place) {
        drawn.charts.push_back(over_time("drive-" + drive, "Drive: " + drive, "Voltage", "V", shown));
        drawn.charts.back().height = 210;
      }
      drawn.charts[place++].series.push_back({table, "level", run.words, run.role});
    }
  }
  return svg_page(finding(r), r.given.scene.title, drawn, 1);
}

std::string release_csv(const OpeningResult& r) {
  const Opening& o = r.best ? *r.best : r.plain;
  const std::map<std::string, Signal> signals = voltages(r, o);
  const std::string whole = csv(signals, o.voltages_end);
  const auto row_end = [&](std::size_t from) { return whole.find('\n', from) + 1; };
  const std::size_t first = row_end(0), second = row_end(first);
  // A closing's drives begin at 0 V, which these did not.
  const bool jumps = whole.compare(second, 2, "0,") == 0;
  std::string held = "0";
  bool begins_held = true;
  for (const auto& [drive, signal] : signals) {
    const double hold = hold_of(r, drive);
    held += fmt::format(",{}", hold);
    begins_held = begins_held && signal.voltage(0) == hold;
  }
  return whole.substr(0, first) + (begins_held ? "" : held + "\n") + whole.substr(jumps ? second : first);
}

}  // namespace softland
