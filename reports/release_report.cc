#include "reports/release_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "base/require.h"
#include "document/chart.h"
#include "document/document.h"
#include "document/quantity.h"
#include "document/svg.h"
#include "reports/closing_record.h"
#include "reports/robustness_prose.h"
#include "reports/study_members.h"
#include "studies/closing/summits_at_hold.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using internal::percent;
using internal::quantity;
using internal::share_text;
using internal::spread_prose;
using nlohmann::json;

constexpr const char* plain_prose = "plain opening";
constexpr double curve_tolerance = 1e-4;  // largest error of the piecewise linear waveforms, as a share of the peak voltage

// Returns the signals of all electrodes and piezos in an opening, by name.
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

// Returns the waveform of an electrode or piezo in an opening as points of time [s] and level [V], from the hold level on.
std::vector<std::pair<double, double>> line_of(const OpeningResult& r, const std::string& drive, const Signal& signal,
                                               double end) {
  const double hold = hold_of(r, drive);
  const double size = std::max({std::abs(hold), signal.peak(), 1e-9});
  std::vector<std::pair<double, double>> points = polyline(signal, end, curve_tolerance * size, 0);
  if (points.size() > 1 && points[0].first == 0 && points[1].first == 0)
    points.erase(points.begin());  // remove the start at 0 V: an opening starts at the hold level
  if (points.front().second != hold) points.insert(points.begin(), {0, hold});
  return points;
}

ReleaseRecord::Run run_of(const OpeningResult& r, const Opening& o) {
  ReleaseRecord::Run run{.figures = o.figures, .message = o.trajectory.message, .drives_end = o.voltages_end, .waveforms = {}};
  for (const auto& [drive, signal] : voltages(r, o)) {
    Points& points = run.waveforms[drive];
    for (const auto& [time, voltage] : line_of(r, drive, signal, o.voltages_end)) points.push_back({time, voltage});
  }
  return run;
}

ReleaseRecord::Gap gap_of(const OpeningResult& r, const Opening& o) {
  CurveRecord curve = curve_of(o.trajectory, r.given.scene.metrics);
  return {.time = std::move(curve.time), .gap = std::move(curve.gap)};
}

std::string gain(double plain, double best) {
  if (!(plain > 0) || !(best > 0) || !std::isfinite(plain) || best > (1 - least_gain) * plain) return {};
  return internal::times(plain / best) + " less";
}

TableRow quantity_row(const ReleaseRecord& r, const std::string& name, double OpeningFigures::*member, std::string_view unit,
                      bool lower) {
  const double plain = r.plain.figures.*member;
  if (!r.best) return {name, quantity(plain, unit)};
  const double best = r.best->figures.*member;
  return {name, quantity(plain, unit), quantity(best, unit), lower ? gain(plain, best) : ""};
}

std::string finding(const ReleaseRecord& r) {
  const OpeningFigures& plain = r.plain.figures;
  const auto ends = [](const OpeningFigures& f) {
    if (!std::isfinite(f.release_time)) return std::string("stays closed");
    return std::isfinite(f.settling_time) ? fmt::format("is at rest after {}", quantity(f.settling_time, "s"))
                                          : std::string("is not yet at rest when the window ends");
  };
  const std::string words = fmt::format("Switched off abruptly, the beam {}", ends(plain));
  if (!r.best) return words + ".";
  if (gains(r.best->figures, plain)) return fmt::format("{}; with the found waveform it {}.", words, ends(r.best->figures));
  return fmt::format("{}. No waveform is recommended: the best one {}, a gain below {}.", words, ends(r.best->figures),
                     percent(least_gain));
}

// Describes how the figures of merit of the opening were computed and confirmed.
std::string remarks(const ReleaseRecord& r) {
  std::string words = fmt::format(
      "At rest means that the contact point stays within {} of its open position ({} of the contact gap). The residual vibration "
      "is its largest distance from there once all drives stand at 0 V.",
      quantity(r.band, "m"), percent(r.band_share));
  if (!r.best) return words + " No waveform was found that opens the switch.";
  words += fmt::format(" The search simulated {} waveforms, with seed {}.", r.evaluations, r.seed);
  if (r.best->drives_end > r.plain.drives_end)
    words += fmt::format(
        " The found waveform ends after {}, the abrupt one after {}. A cycle closes the switch again after its end only, so "
        "that the waveform may lower the rate of cycling: softland cycle compares both.",
        quantity(r.best->drives_end, "s"), quantity(r.plain.drives_end, "s"));
  for (const ConfirmingOpening& c : r.checks) {
    words += fmt::format(" Simulated again with {}: {}.", c.name,
                         std::isfinite(c.figures.residual_vibration)
                             ? "residual vibration " + quantity(c.figures.residual_vibration, "m")
                             : std::string(to_string(c.figures.status)));
  }
  return words;
}

// Returns the end of the time range of the charts [s]: three times the time at which the switch is at rest with all electrodes
// and piezos at 0 V.
double shown_until(const ReleaseRecord& r, double window) {
  constexpr double longer = 3;
  if (!r.best) return window;
  const double end = std::fmax(r.best->drives_end, r.best->figures.settling_time);
  return std::min(window, longer * end);
}

// Returns a table of 95th percentiles of figures of merit over the devices: for the plain opening, in which all electrodes and
// piezos drop to 0 V at once, and for the found opening.
ReportSection devices_section(const ReleaseRecord::Devices& found) {
  ReportTable table{.head = {"", plain_prose, "found"}, .rows = {}};
  table.rows = {{"come to rest in the open position", share_text(found.plain.open), share_text(found.best.open)},
                {"at rest as soon as the drives stand at 0 V", share_text(found.plain.in_band), share_text(found.best.in_band)}};
  const auto add = [&](const char* name, double DeviceOpenings::*figure, const char* unit) {
    const auto value = [&](double v) { return std::isfinite(v) ? quantity(v, unit) : std::string("∞"); };
    table.rows.push_back({name, value(found.plain.*figure), value(found.best.*figure)});
  };
  add("settling time, 95th percentile", &DeviceOpenings::settling_time, "s");
  add("residual vibration, 95th percentile", &DeviceOpenings::residual_vibration, "m");
  add("overshoot beyond the open position, 95th percentile", &DeviceOpenings::overshoot, "m");
  return {.id = "devices",
          .heading = "Under process variation",
          .parts = {Paragraph{fmt::format(
                        "{} devices, all driven with the voltages of the nominal design. Process variation: {}{}.", found.count,
                        found.spread, found.spread_assumed ? " (assumed, because the scene has no [spread])" : "")},
                    std::move(table)}};
}

ReportTable openings_table(const ReleaseRecord& r) {
  ReportTable table{.head = {"", plain_prose, r.best ? "found" : "", {"", "words"}}, .rows = {}};
  table.rows = {quantity_row(r, "leaves its contact after", &OpeningFigures::release_time, "s", false),
                quantity_row(r, "settling time in the open position", &OpeningFigures::settling_time, "s", true),
                quantity_row(r, "residual vibration", &OpeningFigures::residual_vibration, "m", true),
                quantity_row(r, "overshoot beyond the open position", &OpeningFigures::overshoot, "m", true),
                {"touches after the opening", std::to_string(r.plain.figures.touches),
                 r.best ? std::to_string(r.best->figures.touches) : ""}};
  return table;
}

ReportTable parameters_table(const ReleaseRecord& r) {
  ReportTable table{.head = {"parameter", "value"}, .rows = {}};
  for (const auto& [name, value] : r.parameters)
    table.rows.push_back({name, quantity(value, name.find(".level_") == std::string::npos ? "s" : "V", 4)});
  return table;
}

}  // namespace

void members(internal::Archive& a, OpeningFigures& figures) {
  a("status", figures.status, "outcome of the opening");
  a("release_time_s", figures.release_time, "last time at which the contact opens");
  a("settling_time_s", figures.settling_time, "time from which the contact point stays in the band");
  a("overshoot_m", figures.overshoot, "largest excursion beyond the open position");
  a("residual_vibration_m", figures.residual_vibration, "largest distance from the open position once the drives are at 0 V");
  a("touches_again", figures.touches, "number of touches after the first opening");
}

void members(internal::Archive& a, ReleaseRecord::Run& run) {
  a("figures", run.figures, "figures of the opening");
  a("message", run.message, "why the run is not done");
  a("drives_end_s", run.drives_end, "time from which all drives are at 0 V");
  a("waveforms", run.waveforms, "waveform of each drive from its hold level on: time [s], level [V]");
}

void members(internal::Archive& a, ConfirmingOpening& check) {
  a("name", check.name, "what differs in the repeated simulation");
  a("figures", check.figures, "figures of the opening");
}

void members(internal::Archive& a, DeviceOpenings& openings) {
  a("open", openings.open, "share of devices that stay open");
  a("in_band_with_drives", openings.in_band, "share of devices in the band as soon as the drives are at 0 V");
  a("settling_time_s", internal::OrInfinite{openings.settling_time}, "95th percentile of the settling time");
  a("residual_vibration_m", internal::OrInfinite{openings.residual_vibration}, "95th percentile of the residual vibration");
  a("overshoot_m", internal::OrInfinite{openings.overshoot}, "95th percentile of the overshoot");
}

void members(internal::Archive& a, ReleaseRecord::Devices& devices) {
  a("count", devices.count, "number of devices");
  a("spread_assumed", devices.spread_assumed, "whether the scene has no [spread] and the usual one was assumed");
  a("spread", devices.spread, "the process variation in words");
  a("plain", devices.plain, "openings by the abrupt step");
  a("best", devices.best, "openings by the best waveform");
}

void members(internal::Archive& a, ReleaseRecord::Gap& course) {
  a("time_s", course.time, "time");
  a("tip_gap_m", course.gap, "gap of the contact");
}

void members(internal::Archive& a, ReleaseRecord& r) {
  members(a, r.origin);
  a("status", r.status, "outcome of the opening, or `interrupted`");
  a("actuator", internal::Chosen{r.actuator, actuators}, "drives that were searched");
  a("hold_levels", r.hold_levels, "level of each drive before the opening");
  a("contact_force_N", r.contact_force, "contact force before the opening");
  a("open_position_m", r.open_position, "open rest position of the contact point");
  a("band_m", r.band, "distance from it within which the switch is at rest");
  a("band_of_contact_gap", r.band_share, "the same as a share of the contact gap");
  a("plain", r.plain, "opening by the abrupt step");
  a("best", internal::OrNull{r.best}, "opening by the best waveform");
  a("parameters", r.parameters, "parameters of the best waveform");
  a("confirmed_by", r.checks, "repeated simulations");
  a("devices", internal::OrNull{r.devices}, "openings under process variation");
  a("goal_met", r.goal_met, "whether the settling time is met");
  a("confirmed", r.confirmed, "whether the repeated simulations agree");
  a("evaluations", r.evaluations, "number of evaluations");
  a("seed", r.seed, "seed of the search");
  a("termination", r.termination, "why the search ended");
  a("warnings", r.warnings, "warnings");
  if (a.has(!r.gaps.empty())) a("curves", r.gaps, "gap over time of each opening, in files only");
}

ReleaseRecord record_of(const OpeningResult& r, const std::string& command) {
  ReleaseRecord record{
      .origin = origin_of("release", r.given, command),
      .status = std::string(r.interrupted ? "interrupted" : to_string((r.best ? *r.best : r.plain).trajectory.status)),
      .actuator = r.options.actuator,
      .hold_levels = {},
      .contact_force = r.contact_force,
      .open_position = r.open_position,
      .band = r.band,
      .band_share = r.options.band,
      .plain = run_of(r, r.plain),
      .best = {},
      .parameters = r.parameters,
      .checks = r.checks,
      .devices = {},
      .goal_met = r.goal_met,
      .confirmed = r.confirmed,
      .evaluations = r.search.evaluations,
      .seed = r.options.seed,
      .termination = std::string(to_string(r.search.termination)),
      .warnings = r.given.scene.warnings,
      .gaps = {{"plain", gap_of(r, r.plain)}}};
  const std::vector<std::string> names = r.given.drive_names();
  for (std::size_t k = 0; k < names.size(); ++k) record.hold_levels[names[k]] = r.holds[k];
  if (r.best) record.best = run_of(r, *r.best), record.gaps["best"] = gap_of(r, *r.best);
  if (const auto& d = r.on_devices) record.devices = {d->devices, d->spread_assumed, spread_prose(d->spread), d->plain, d->best};
  if (std::string few = few_summits_warning(r.given.model, r.given.signals()); !few.empty())
    record.warnings.push_back(std::move(few));
  return record;
}

json json_of(const ReleaseRecord& record) { return internal::record_json(record); }

ReleaseRecord read_release(const json& from) {
  ReleaseRecord record = internal::whole_record<ReleaseRecord>(from);
  for (const char* run : {"plain", "best"})
    require(record.gaps.empty() || record.gaps.contains(run) || (run == std::string("best") && !record.best),
            "\"curves\" lacks a run");
  return record;
}

std::string text_of(const ReleaseRecord& r) {
  ReportSection opening{.id = "opening", .heading = "The opening", .parts = {openings_table(r)}};
  if (r.best) opening.parts.emplace_back(parameters_table(r));
  Document document{.headline = finding(r),
                    .doubt = r.status == "interrupted" ? "Interrupted: the best waveform so far is shown." : "",
                    .sections = {std::move(opening)},
                    .warnings = r.warnings};
  if (r.devices) document.sections.push_back(devices_section(*r.devices));
  document.sections.push_back({.id = "remarks", .heading = "Remarks", .parts = {Paragraph{remarks(r)}}});
  return terminal_text(document);
}

std::string svg_of(const ReleaseRecord& r) {
  const std::vector<double>& times = r.gaps.at("plain").time;
  const double shown = shown_until(r, times.empty() ? r.plain.drives_end : times.back());
  struct Drawn {
    const ReleaseRecord::Run* run;
    const char *name, *words;
    internal::Role role;
  };
  std::vector<Drawn> runs{{&r.plain, "plain", plain_prose, internal::Role::baseline}};
  if (r.best) runs.push_back({&*r.best, "best", "found", internal::Role::best});
  internal::Picture drawn;
  internal::Chart gap = internal::chart_over_time("gap", "Gap: the opening", "Gap", "m", shown, 320);
  gap.zero_line = true;
  gap.zero_label = "contact plane";
  for (const Drawn& run : runs) {
    const auto& [time, gap_then] = r.gaps.at(run.name);
    drawn.tables[run.name] = {{"time_s", time}, {"tip_gap_m", gap_then}};
    gap.series.push_back({run.name, "tip_gap_m", run.words, run.role});
  }
  drawn.charts.push_back(gap);
  for (const Drawn& run : runs) {
    std::size_t place = 1;  // position of the chart of this waveform among the charts of the page
    for (const auto& [drive, points] : run.run->waveforms) {
      const std::string table = fmt::format("{}/{}", run.name, drive);
      Points line = points;
      if (!line.empty() && line.back()[0] < shown) {  // the waveform remains at its last level until the end of the chart
        const bool is_flat = line.size() > 1 && line[line.size() - 2][1] == line.back()[1];
        if (!is_flat) line.push_back(line.back());
        line.back()[0] = shown;
      }
      for (const auto& [time, voltage] : line) {
        drawn.tables[table]["time_s"].push_back(time);
        drawn.tables[table]["level"].push_back(voltage);
      }
      if (drawn.charts.size() == place) {
        drawn.charts.push_back(internal::chart_over_time("drive-" + drive, "Drive: " + drive, "Voltage", "V", shown, 210));
      }
      drawn.charts[place++].series.push_back({table, "level", run.words, run.role});
    }
  }
  return svg_page(finding(r), title_of(r.origin), drawn, 1);
}

std::string release_csv(const OpeningResult& r) {
  const Opening& o = r.best ? *r.best : r.plain;
  const std::map<std::string, Signal> signals = voltages(r, o);
  const std::string whole = csv(signals, o.voltages_end);
  const auto row_end = [&](std::size_t from) { return whole.find('\n', from) + 1; };
  const std::size_t first = row_end(0), second = row_end(first);
  // csv() starts all waveforms at 0 V, as is right for a closing. An opening starts at the hold levels: replace the first row.
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
