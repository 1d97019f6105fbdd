#include "reports/devices_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "document/escape.h"
#include "document/page.h"
#include "document/quantity.h"
#include "reports/closing_prose.h"
#include "reports/device_gaps.h"
#include "reports/robustness_prose.h"

namespace softland {

namespace {

using namespace internal;

constexpr double half = 0.5;

// A column of a table: the 95th percentile of a figure of merit over the devices and, with `with_99`, the 99th percentile
// beside it.
struct Column {
  std::string_view key, heading, short_heading;
  bool with_99 = false;
  ShownIn shown = ShownIn::everywhere;
};
constexpr std::array columns{Column{key_of(&Metrics::largest_impact_velocity), "largest impact velocity", "largest impact", true},
                             Column{key_of(&Metrics::major_bounce_height), "highest rebound", "rebound", true},
                             Column{key_of(&Metrics::peak_contact_force), "peak force", "peak force"},
                             Column{key_of(&Metrics::steady_force_time), "steady force from", "steady from"},
                             Column{key_of(&Metrics::permanent_contact_time), "settling time", "", false, ShownIn::page},
                             Column{key_of(&Metrics::initial_contact_time), "first contact", "first contact"}};

constexpr std::string_view steady_key = key_of(&Metrics::steady_force_time);

double value_in(const std::map<std::string, double>& values, std::string_view key) {
  const auto found = values.find(std::string(key));
  return found == values.end() ? Metrics::unset : found->second;
}

std::string speed_of(const DevicesFindings::Row& row) {
  const auto found = row.at_95.find(std::string(columns[0].key));
  return found == row.at_95.end() || !std::isfinite(found->second) ? std::string("∞") : quantity(found->second, "m/s");
}

std::string figure_name(std::string_view key) {
  std::string name(figure_of(key).name);
  if (!name.empty()) name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  return name;
}

std::string cell_of(std::string_view key, double value) {
  if (std::isinf(value)) return "∞";
  if (std::isnan(value)) return "—";
  if (key == key_of(&Metrics::major_bounce_height) && value == 0) return "none";
  return quantity(value, figure_of(key).unit);
}

// Returns two values as text, the second in parentheses: "2.45 (33.8) mm/s"; with different units "723 µm/s (34.0 mm/s)".
std::string with_bracket(const std::string& value, const std::string& other) {
  constexpr std::string_view blank = "\u00a0";
  const std::size_t unit = value.find(blank), other_unit = other.find(blank);
  const bool is_same =
      unit != std::string::npos && other_unit != std::string::npos && value.substr(unit) == other.substr(other_unit);
  return is_same ? fmt::format("{} ({}){}", value.substr(0, unit), other.substr(0, other_unit), value.substr(unit))
                 : fmt::format("{} ({})", value, other);
}

// Returns the cell "2.0 / 97.9 / 100 %": the shares of devices whose highest rebound is at most each height of yield_heights.
std::string yields_cell(const DevicesFindings::Row& row) {
  if (row.yield.empty()) return "—";
  std::string cell;
  for (const auto& [height, key] : DevicesFindings::yield_heights)
    cell += (cell.empty() ? "" : " / ") + share_number(value_in(row.yield, key));
  return cell + " %";
}

bool is_calibrated(const DevicesFindings::Row& row) { return std::isfinite(row.pull_in_error) || std::isfinite(row.time_error); }

// Returns true for devices that are measured without a gain: the waveform and the figures are those of best.toml.
bool is_without_gain(const DevicesFindings& d, const DevicesFindings::Row& row) {
  const DevicesFindings::Row* const own = d.row(for_the_devices);
  return is_calibrated(row) && own != nullptr && row.name != d.measured && row.bounce_free == own->bounce_free &&
         value_in(row.at_95, columns[0].key) == value_in(own->at_95, columns[0].key);
}

// Returns the name of a row in tables of waveforms: the choice (such as the fastest) and the file of the waveform.
std::string shown_name(const DevicesFindings& d, const DevicesFindings::Row& row) {
  if (row.name == for_nominal_design) return "nominal design: drawing.toml";
  for (const DevicesFindings::Choice& one : d.choices) {
    if (one.row() == row.name) return fmt::format("{}: {}", one.name, one.file);
  }
  return row.name == for_the_devices ? "best.toml" : is_calibrated(row) ? "per-device calibration: " + row.name : row.name;
}

// Least share of devices with a failure, such as a switch that stays open, for which a table has a column.
constexpr double least_share = 0.0005;

// Returns true if a share of devices, such as that of devices that stay open, exceeds least_share in any row of the table.
bool any_of(const std::vector<DevicesFindings::Row>& rows, double DevicesFindings::Row::*share) {
  return std::ranges::any_of(rows, [&](const DevicesFindings::Row& row) { return row.*share > least_share; });
}

// Returns a column heading whose text is longer on a page than on a terminal.
TableCell headed(std::string_view on_terminal, std::string_view on_page) {
  TableCell cell(on_terminal);
  cell.html = escaped(capitalised(std::string(on_page)));
  return cell;
}

// Draws the waveforms among which the user can choose, and the plain step, as points: largest impact velocity against the time
// from which the contact force is steady.
std::string choices_picture(const DevicesFindings& d) {
  if (d.choices.size() < 2) return {};
  CurveTables tables;
  CurveTable& table = tables["choices"];
  Chart chart{
      .id = "choices",
      .title = "Largest impact velocity against time",
      .caption =
          "Both axes are 95th percentiles over the devices: the largest impact velocity against the time from which the contact "
          "force is steady.",
      .x_column = "steady",
      .x_label = "Steady force from, 95th percentile",
      .x_unit = "s",
      .y_label = "Largest impact velocity, 95th percentile",
      .y_unit = "m/s",
      .scale = AxisScale::logarithmic,
      .height = 260,
      .series = {{.table = "choices", .column = "speed", .label = "", .role = Role::best}}};
  double last = 0, softest = std::numeric_limits<double>::infinity(), hardest = 0;
  const auto point = [&](const std::string& name, Role role, bool is_choice) {
    const DevicesFindings::Row* row = d.row(name);
    if (row == nullptr) return;
    const double time = value_in(row->at_95, steady_key), speed = value_in(row->at_95, columns[0].key);
    if (!std::isfinite(time) || !(speed > 0) || !std::isfinite(speed)) return;
    if (is_choice) table["steady"].push_back(time), table["speed"].push_back(speed);
    const std::string shown = shown_name(d, *row);
    chart.marks.push_back({.x = time, .y = speed, .role = role, .text = shown.substr(0, shown.find(':'))});
    last = std::max(last, time);
    softest = std::min(softest, speed), hardest = std::max(hardest, speed);
  };
  for (const DevicesFindings::Choice& one : d.choices) point(one.row(), Role::best, true);
  if (table["steady"].size() < 2) return {};
  if (d.stable_path && d.stable_path->touch_places > 0) {
    const DevicesFindings::StablePath& path = *d.stable_path;
    CurveTable& bound = tables["bound"];
    constexpr int points = 60;
    for (int i = 0; i <= points; ++i) {
      const double time = path.rise + (1.15 * last - path.rise) * (i + 1) / (points + 1.0);
      bound["steady"].push_back(time), bound["speed"].push_back(path.touch_places / (time - path.rise));
    }
    chart.series.push_back(
        {.table = "bound", .column = "speed", .label = "bound: touch positions crossed at constant speed", .role = Role::limit});
    softest = std::min(softest, bound["speed"].back());
  }
  point(plain_step_row, Role::baseline, false);
  point(undelayed_row, Role::baseline, false);
  chart.x_home = chart.x_whole = {0.0, 1.15 * last};
  chart.y_home = {softest / 2, 2 * hardest};
  return "<div class=\"multiples\" style=\"max-width: 560px; grid-template-columns: 1fr\">\n" + small_picture(tables, chart) +
         "</div>\n";
}

// Draws the bounce-free share of devices and the impact velocity against the error of the measured pull-in voltage Vdp. Nothing
// is drawn if they do not depend on it.
std::string error_curve(const DevicesFindings& d) {
  const auto is_first = [&](const CalibrationError& one) {
    return one.bounce_free == d.by_error.front().bounce_free && one.impact_speed == d.by_error.front().impact_speed;
  };
  if (std::ranges::all_of(d.by_error, is_first)) return {};
  CurveTables tables;
  CurveTable& table = tables["by-error"];
  for (const CalibrationError& known : d.by_error) {
    table["error"].push_back(100 * known.error);
    table["share"].push_back(100 * known.bounce_free);
    table["speed"].push_back(known.impact_speed);
  }
  const std::array ends{table["error"].front(), table["error"].back()};
  Chart share{.id = "share-by-error",
              .title = "Bounce-free devices against the error of Vdp",
              .caption =
                  "Share of the devices that close bounce-free if Vdp of each is measured with this error, under the waveform "
                  "with the largest share.",
              .x_column = "error",
              .x_label = "Error of Vdp",
              .x_unit = "%",
              .y_label = "Devices",
              .y_unit = "%",
              .x_scale = AxisScale::logarithmic,
              .x_home = ends,
              .x_whole = ends,
              .y_home = std::array{0.0, 100.0},
              .height = 200,
              .series = {{.table = "by-error", .column = "share", .label = "", .role = Role::best}}};
  Chart speed = share;
  speed.id = "speed-by-error";
  speed.title = "Largest impact velocity against the error of Vdp";
  speed.caption =
      "95th percentile of the largest impact velocity if Vdp of each device is measured with this error, under the waveform with the "
      "lowest value.";
  speed.y_label = "Largest impact velocity";
  speed.y_unit = "m/s";
  speed.y_home.reset();
  speed.series.front().column = "speed";
  return "<div class=\"multiples\">\n" + small_picture(tables, share) + small_picture(tables, speed) + "</div>\n";
}

}  // namespace

std::string internal::nominal_prose(const DevicesFindings& d) {
  const double closed = d.nominal[&Metrics::permanent_contact_time], height = d.nominal[&Metrics::major_bounce_height];
  if (d.nominal_goal_met && std::isfinite(closed)) {
    const DevicesFindings::Row* row = d.row(for_nominal_design);
    const std::string on_devices =
        row == nullptr ? "" : fmt::format(" (95th percentile of the largest impact velocity on the devices: {})", speed_of(*row));
    return fmt::format("drawing.toml, searched for the nominal design alone, closes it bounce-free at {}{}.",
                       quantity(closed, "s"), on_devices);
  }
  if (!std::isfinite(height))
    return "No waveform was found that keeps the nominal design closed; drawing.toml is the best of them.";
  return fmt::format("drawing.toml, searched for the nominal design alone, lets it rebound by up to {}.", quantity(height, "m"));
}

std::string internal::devices_headline(const ClosingRecord& result) {
  const DevicesFindings& d = *result.devices();
  const DevicesFindings::Row *step = d.row(plain_step_row), *own = d.row(for_the_devices);
  if (step == nullptr || own == nullptr) return {};
  const std::string assumed = d.spread_assumed ? " (assumed, because the scene has no [spread]: " + d.spread + ")" : "";
  if (!d.better_than_plain_step) {
    std::string figures;
    for (const std::string& key : d.worse_in) figures += (figures.empty() ? "" : " and ") + figure_name(key);
    return fmt::format(
        "{}Under process variation{}, no waveform that was found is as good as the plain step: the best one is worse in its {}. "
        "best.toml is the plain step.",
        d.goal_met == true ? "The plain step does not bounce on 95 % of the devices. " : "", assumed, figures);
  }
  const std::string lands = own->bounce_free >= half ? fmt::format("{} close bounce-free (plain step {}), and 95 % touch",
                                                                   share_text(own->bounce_free), share_text(step->bounce_free))
                                                     : std::string("95 % touch");
  std::string words = fmt::format("Of {:.0f} simulated devices{}, {} at no more than {} instead of {}", d.count, assumed, lands,
                                  speed_of(*own), speed_of(*step));
  const double steady = value_in(own->at_95, steady_key), of_step = value_in(step->at_95, steady_key);
  if (std::isfinite(steady) && std::isfinite(of_step))
    words += fmt::format(", and carry a steady force from {} on instead of {}", quantity(steady, "s"), quantity(of_step, "s"));
  return words + ": best.toml.";
}

std::vector<KeyNumber> internal::devices_keys(const DevicesFindings& d) {
  const DevicesFindings::Row *step = d.row(plain_step_row), *own = d.row(for_the_devices);
  if (step == nullptr || own == nullptr) return {};
  std::vector<KeyNumber> keys;
  // The key numbers are the first columns of the table, up to the time of steady contact force.
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string_view key = columns[i].key;
    keys.push_back({.name = capitalised(std::string(columns[i].heading)) + ", 95th percentile",
                    .value = cell_of(key, value_in(own->at_95, key)),
                    .before = cell_of(key, value_in(step->at_95, key))});
  }
  return keys;
}

namespace {

// Returns a table with a row per pair in `rows`: the name of a waveform, and its figures of merit on the devices.
ReportTable devices_table(const DevicesFindings& d, const std::vector<std::pair<std::string, const DevicesFindings::Row*>>& rows,
                          ShownIn where) {
  ReportTable table{.head = {"95th percentile (99th)"}, .rows = {}};
  std::vector<Column> shown;
  std::ranges::copy_if(columns, std::back_inserter(shown),
                       [&](const Column& c) { return c.shown == ShownIn::everywhere || c.shown == where; });
  for (const Column& c : shown) table.head.push_back(headed(c.short_heading, c.heading));
  table.head.push_back(headed("≤ 1 / 10 / 100 nm", "share of devices with rebounds ≤ 1 / 10 / 100 nm"));
  const bool stay_open = any_of(d.rows, &DevicesFindings::Row::open),
             pulled_in = any_of(d.rows, &DevicesFindings::Row::collapsed);
  if (stay_open && pulled_in) table.head.push_back(headed("open / collapsed", "stay open / collapse onto the electrode"));
  if (stay_open && !pulled_in) table.head.emplace_back("stay open");
  if (pulled_in && !stay_open) table.head.push_back(headed("collapsed", "collapse onto the electrode"));
  for (const auto& [name, row] : rows) {
    TableRow& line = table.rows.emplace_back(TableRow{name});
    const char* const style = row->name == for_the_devices ? "own" : "";
    for (const Column& c : shown) {
      std::string cell = cell_of(c.key, value_in(row->at_95, c.key));
      if (c.with_99 && !row->at_99.empty()) cell = with_bracket(cell, cell_of(c.key, value_in(row->at_99, c.key)));
      line.emplace_back(std::move(cell), style);
    }
    line.emplace_back(yields_cell(*row), style);
    const double open = std::max(0.0, row->open);
    if (stay_open && pulled_in) line.emplace_back(share_number(open) + " / " + share_text(row->collapsed), style);
    if (stay_open != pulled_in) line.emplace_back(share_text(stay_open ? open : row->collapsed), style);
  }
  return table;
}

// Returns a table of the waveforms among which the user can choose, the plain step, and the best waveform with per-device
// calibration.
ReportTable choices_table(const DevicesFindings& d) {
  std::vector<std::pair<std::string, const DevicesFindings::Row*>> rows;
  const auto add = [&](const std::string& row) {
    if (const DevicesFindings::Row* found = d.row(row)) rows.emplace_back(shown_name(d, *found), found);
  };
  add(plain_step_row);
  for (const DevicesFindings::Choice& one : d.choices) add(one.row());
  if (d.choices.empty() && d.better_than_plain_step) add(for_the_devices);
  add(undelayed_row);
  if (!d.measured.empty()) add(d.measured);
  return devices_table(d, rows, ShownIn::terminal);
}

// Returns a table of the plain step and all found waveforms, those that have files of their own first. Measured devices without a
// gain are left out: a sentence below the table tells of them.
ReportTable all_rows(const DevicesFindings& d) {
  std::vector<std::pair<std::string, const DevicesFindings::Row*>> rows;
  const auto add = [&](const DevicesFindings::Row* row) {
    if (row != nullptr && std::ranges::none_of(rows, [&](const auto& there) { return there.second == row; }))
      rows.emplace_back(shown_name(d, *row), row);
  };
  add(d.row(plain_step_row));
  for (const DevicesFindings::Choice& one : d.choices) add(d.row(one.row()));
  for (const DevicesFindings::Row& row : d.rows) {
    if (!is_without_gain(d, row)) add(&row);
  }
  return devices_table(d, rows, ShownIn::page);
}

// Describes the drive that moves the switch to its contact, or could: "The piezo carries 96.3 % of the devices to their contact
// ..."
std::string path_prose(const DevicesFindings& d) {
  if (!d.stable_path) return {};
  const DevicesFindings::StablePath& path = *d.stable_path;
  const std::string drive = path.drives.front() == piezo_drive ? "piezo" : "electrode " + path.drives.front();
  const bool is_used = d.better_than_plain_step && d.waveform.starts_with(quasi_static_family);
  std::string words = fmt::format(
      "The {} {} {} of the devices to their contact through stable equilibria within {} (the nominal design touches at {}){}.",
      drive, is_used ? "carries" : "alone can carry", share_text(path.share), quantity(path.limit, "V"),
      quantity(path.reaches, "V"), is_used ? "" : ", but best.toml does not do so");
  if (is_used && path.share < 1)
    words += " The electrode pulls in the others, at a larger impact velocity (see the 99th percentile).";
  if (drive == "piezo") words += " The model has no creep and no hysteresis of the piezo.";
  return words;
}

std::string delay_prose(const DevicesFindings& d) {
  if (!std::isfinite(d.step_delay) || !d.better_than_plain_step) return {};
  return fmt::format(
      "The plain step of the electrode is delayed to {}, when the piezo has closed the contact; --hold-step fixed keeps it at t "
      "= 0.",
      quantity(d.step_delay, "s"));
}

// Describes the gain by scaling the waveform to each device's measured pull-in voltage (per-device calibration).
std::string measuring_prose(const DevicesFindings& d) {
  const DevicesFindings::Row *own = d.row(for_the_devices), *measured = d.row(d.measured);
  const bool were_judged =
      std::ranges::any_of(d.rows, [](const DevicesFindings::Row& row) { return std::isfinite(row.pull_in_error); });
  if (measured == nullptr && were_judged)
    return fmt::format(
        "Per-device calibration does not help: neither Vdp measured to 1 % nor a closing time measured to 50 ns on each device "
        "gives {}.",
        own != nullptr && own->bounce_free >= half ? "more bounce-free devices" : "lower impact velocities");
  if (own == nullptr || measured == nullptr || d.next_command.empty()) return {};
  const char* const what = std::isfinite(measured->time_error) ? "one closing time measured to 50 ns" : "Vdp measured to 1 %";
  const bool lands_more = measured->bounce_free >= half && measured->bounce_free > own->bounce_free;
  return lands_more
             ? fmt::format("With per-device calibration ({}), {} of the devices close bounce-free: calibrated.toml.", what,
                           share_text(measured->bounce_free))
             : fmt::format(
                   "With per-device calibration ({}), the 95th percentile of the largest impact velocity is {}: calibrated.toml.",
                   what, speed_of(*measured));
}

std::string export_heading(const DevicesFindings& d) {
  return d.measured.empty() ? "Export for the voltage source" : "Export for a measured device";
}

}  // namespace

ReportSection internal::choices_section(const DevicesFindings& d) {
  ReportSection section{.id = "choices", .heading = "Choices", .parts = {}, .shown = ShownIn::terminal};
  if (d.rows.empty()) return section;
  section.parts.emplace_back(choices_table(d));
  section.parts.emplace_back(
      Paragraph{"≤ 1 / 10 / 100 nm is the share of devices whose highest rebound is at most 1, 10 and 100 nm."});
  std::string words = fmt::format("Process variation: {}.", d.spread);
  for (const std::string& more : {path_prose(d), delay_prose(d), measuring_prose(d), nominal_prose(d)})
    words += (more.empty() ? "" : " ") + more;
  section.parts.emplace_back(Paragraph{std::move(words)});
  if (!d.next_command.empty()) {
    section.parts.emplace_back(SubHeading{export_heading(d)});
    section.parts.emplace_back(ReportList{{d.next_command}});
  }
  return section;
}

ReportSection internal::devices_section(const DevicesFindings& d) {
  ReportSection section{.id = "devices", .heading = "Process variation", .parts = {}, .shown = ShownIn::page};
  if (d.rows.empty()) return section;
  const auto note = [&](std::string text) { section.parts.emplace_back(Paragraph{.text = std::move(text), .is_note = true}); };
  section.parts.emplace_back(Drawing{[&d](const Picture&) { return gaps_html(d); }});
  section.parts.emplace_back(all_rows(d));
  section.parts.emplace_back(Drawing{[&d](const Picture&) { return choices_picture(d); }});
  for (const std::string& words : {path_prose(d), delay_prose(d), measuring_prose(d)}) {
    if (!words.empty()) note(words);
  }
  if (!d.measure.empty())
    note(fmt::format(
        "best.toml is a {} waveform. The search minimized {} and took {:.0f} closings in all. Process variation: {}.{}",
        d.waveform, d.measure == "drawing" ? "the cost of the nominal design" : d.measure, d.closings, d.spread,
        d.spread_assumed ? " It is assumed, because the scene has no [spread]." : ""));
  if (d.missed_by > 0)
    note(fmt::format("The 95th percentile of the highest rebound is {}, {} above the height from which rebounds count.",
                     cell_of(columns[1].key, value_in(d.row(for_the_devices)->at_95, columns[1].key)),
                     quantity(d.missed_by, "m")));
  section.parts.emplace_back(Drawing{[&d](const Picture&) { return error_curve(d); }});
  note(window_prose(d.windows));
  for (const FulfilledCondition& c : d.conditions)
    note(fmt::format("The condition {} {}: {} of the devices fulfil it.", c.text, c.holds ? "holds" : "does not hold",
                     share_text(c.share.value)));
  if (!d.next_command.empty()) {
    section.parts.emplace_back(SubHeading{export_heading(d)});
    section.parts.emplace_back(ReportList{{d.next_command}});
  }
  section.parts.emplace_back(
      drawing_of("<p class=\"below\"><a href=\"robustness.html\">robustness.html</a> has all figures of the devices.</p>\n"));
  return section;
}

}  // namespace softland
