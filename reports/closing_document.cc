#include "reports/closing_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "document/chart.h"
#include "document/escape.h"
#include "document/page.h"
#include "document/quantity.h"
#include "objectives/figure_values.h"
#include "reports/closing_captions.h"
#include "reports/closing_charts.h"
#include "reports/closing_prose.h"
#include "reports/device_picture.h"
#include "reports/devices_report.h"
#include "reports/motion_figure.h"
#include "reports/record.h"
#include "reports/seeds_report.h"

namespace softland {
namespace {

using namespace internal;

constexpr std::size_t most_lines = 200;

std::string verdict_class(Verdict verdict) {
  switch (verdict) {
    case Verdict::better:
      return "better";
    case Verdict::worse:
      return "worse";
    case Verdict::same:
    case Verdict::neutral:
      break;
  }
  return "neutral";
}

// The figures of merit that show best how the switch closes. They are the columns of the table of confirmations; all but the
// first are key numbers at the top of the page.
constexpr std::array leading_figures{figure_of(&Metrics::initial_contact_time), figure_of(&Metrics::permanent_contact_time),
                                     figure_of(&Metrics::bounce_count), figure_of(&Metrics::major_bounce_height),
                                     figure_of(&Metrics::impact_velocity)};

KeyNumber key_number(const ClosingRecord& result, const Figure& shown) {
  const RunRecord &own = result.best, &step = result.baseline();
  const auto words = [&](const RunRecord& run, const RunRecord& beside) {
    const std::string reason = missing_reason(run, shown);
    return reason.empty() ? quantity_beside(figure_of_run(run, shown.member), figure_of_run(beside, shown.member), shown.unit)
                          : reason;
  };
  const Change changed = figure_change(step, own, shown);
  return {.name = capitalised(std::string(shown.also.empty() ? shown.name : shown.also)),
          .value = words(own, step),
          .change = changed.words,
          .before = result.search && step.figures ? words(step, own) : "",
          .style = verdict_class(changed.verdict),
          .is_words = !missing_reason(own, shown).empty()};
}

std::vector<KeyNumber> key_numbers(const ClosingRecord& result) {
  if (const DevicesFindings* const devices = result.devices()) return devices_keys(*devices);
  if (!result.baseline().figures && !missing_reason(result.best, leading_figures.front()).empty()) return {};
  std::vector<KeyNumber> keys;
  for (const Figure& one : std::span(leading_figures).subspan(1)) keys.push_back(key_number(result, one));
  return keys;
}

/// Adds rows for what each waveform demands of its voltage source (extreme voltages, slew rate) if several electrodes or piezos
/// have waveforms. With `pair`, the table also has the values of the plain step.
void add_drive_rows(ReportTable& table, const ClosingRecord& result, bool pair) {
  if (result.best.waveforms.size() < 2) return;
  for (const auto& [drive, found] : result.best.waveforms) {
    const DriveScale scale = drive_scale(drive);
    if (scale.unit.empty()) continue;  // the waveform is a factor of the dispersion force, which no voltage source supplies
    const DriveDemand own = drive_demand(found, scale.rest);
    const DriveDemand step = drive_demand(waveform(result.baseline(), drive), scale.rest);
    const auto add = [&, name = &drive](const Figure& what, const std::string& value, const std::string& before) {
      TableRow& row = table.rows.emplace_back(TableRow{fmt::format("{}, {}", what.name, *name)});
      if (pair) row.insert(row.end(), {before, ""});
      row.emplace_back(value, "own");
      row.resize(table.head.size(), "");
    };
    const auto slew = [](double value) { return std::isinf(value) ? std::string("jumps") : quantity(value, "V/s"); };
    add(figure_of(&Metrics::peak_voltage), quantity(own.peak(), "V", 4), quantity(step.peak(), "V", 4));
    add(figure_of(&Metrics::peak_slew), slew(own.slew), slew(step.slew));
  }
}

TableCell error_cell(const ClosingRecord& result, const Figure& one) {
  constexpr double ill = 0.1;  // least relative error from which a figure counts as ill-conditioned
  const double own = figure_of_run(result.best, one.member), error = result.best.errors[one];
  const std::string cloud = cloud_text(result, one), stated = error_text(one, own, error);
  const bool is_hidden = stated.starts_with('<');  // true when the error of the figure is below the last digit shown
  TableCell cell(cloud.empty() ? stated : cloud);
  if (!cloud.empty() || (!is_hidden && error > ill * std::abs(own)))
    cell.html = escaped(cell.text) + " <span class=\"note\">ill-conditioned</span>";
  return cell;
}

TableRow figure_row(const ClosingRecord& result, const Figure& one, bool pair, bool estimated) {
  const double own = figure_of_run(result.best, one.member), step = figure_of_run(result.baseline(), one.member);
  TableRow row{one.label()};
  if (pair) row.insert(row.end(), {figure_text(one, step, result.baseline().errors[one], own), goal_text(result, one)});
  row.emplace_back(figure_text(one, own, result.best.errors[one], step), "own");
  if (pair) {
    const Change changed = figure_change(result.baseline(), result.best, one);
    row.emplace_back(changed.words, "change " + verdict_class(changed.verdict));
  }
  if (estimated) row.push_back(error_cell(result, one));
  return row;
}

ReportTable figures_table(const ClosingRecord& result) {
  const bool pair = result.search && result.baseline().figures;
  const bool estimated = std::any_of(all_figures.begin(), all_figures.end(),
                                     [&](const Figure& one) { return std::isfinite(result.best.errors[one]); });
  ReportTable table{.head = {"Figure"}, .rows = {}};
  if (pair) table.head.insert(table.head.end(), {"Plain step", "Goal", "Softland", {"Change", "change"}});
  if (!pair) table.head.emplace_back("Value");
  if (estimated) table.head.emplace_back(error_heading(result));
  for (const Figure& one : all_figures) {
    const bool known =
        !std::isnan(figure_of_run(result.best, one.member)) || !std::isnan(figure_of_run(result.baseline(), one.member));
    if (known) table.rows.push_back(figure_row(result, one, pair, estimated));
  }
  add_drive_rows(table, result, pair);
  return table;
}

// Returns a table of the figures of merit of each of several contacts; the main table is about the electrical connection that
// the contacts make together.
ReportTable contacts_table(const ClosingRecord& result) {
  constexpr std::array shown{&Metrics::initial_contact_time, &Metrics::impact_velocity, &Metrics::major_bounce_height,
                             &Metrics::peak_contact_force, &Metrics::hold_force};
  ReportTable table{.head = {"Contact"}, .rows = {}};
  for (const auto member : shown) table.head.emplace_back(std::string(figure_of(member).name));
  for (const auto& [name, contact] : result.contacts) {
    TableRow& row = table.rows.emplace_back(TableRow{name});
    for (const auto member : shown) {
      const double value = contact.figures[member];
      row.emplace_back(std::isfinite(value) ? quantity(value, figure_of(member).unit) : "—");
    }
  }
  return table;
}

// Returns a note for a scene with a piezo layer: the drive energy does not include the charging of the layer.
std::string uncounted_layer_caption(const ClosingRecord& result) {
  const bool told = std::isfinite(figure_of_run(result.best, &Metrics::drive_energy)) ||
                    std::isfinite(figure_of_run(result.baseline(), &Metrics::drive_energy));
  const json& piezo = value_at(result.origin.scene, "piezo");
  if (!told || value_at(piezo, "thickness").is_null() || !value_at(piezo, "relative_permittivity").is_null()) return {};
  return "The drive energy does not count the charging of the piezo layer: the scene has no piezo.relative_permittivity.";
}

ReportSection figures_section(const ClosingRecord& result) {
  ReportSection section{.id = "figures", .heading = "Figures", .parts = {}};
  if (const DevicesFindings* const devices = result.devices())
    section.parts.emplace_back(
        SubHeading{devices->better_than_plain_step ? "best.toml on the nominal design" : "The plain step on the nominal design"});
  if (result.best.figures || result.baseline().figures) section.parts.emplace_back(figures_table(result));
  if (result.contacts.size() > 1) section.parts.emplace_back(contacts_table(result));
  if (result.search && result.search->goal_met && !result.search->devices)
    section.parts.emplace_back(Paragraph{fmt::format("The goal is {}.", *result.search->goal_met ? "met" : "not met")});
  for (const std::string& words :
       {uncounted_layer_caption(result), limit_prose(result), certificate_caption(result), robust_caption(result)})
    section.parts.emplace_back(Paragraph{words});
  return section;
}

// Returns the charts over time, which share their zoom, and their cursor with the animation of the switch.
std::string closing_charts(const ClosingRecord& result, const Picture& drawn) {
  std::string charts;
  for (const Chart& chart : drawn.charts) {
    if (!chart.group.empty()) charts += figure_html(drawn.tables, chart);
  }
  if (charts.empty()) return charts;
  return "<div class=\"tools\" hidden><span role=\"group\" aria-label=\"Time shown\">"
         "<button type=\"button\" data-view=\"home\" aria-pressed=\"true\">Overview</button>"
         "<button type=\"button\" data-view=\"landing\" aria-pressed=\"false\">Landing</button>"
         "<button type=\"button\" data-view=\"whole\" aria-pressed=\"false\">Whole window</button></span>"
         "<span class=\"hint\">Drag to zoom, double-click to go back. With a chart focused: ← → read, + − zoom, 0 "
         "back.</span></div>\n" +
         motion_figure(result) + charts;
}

std::string search_charts(const Picture& drawn) {
  std::string charts;
  for (const Chart& chart : drawn.charts) {
    if (chart.group.empty()) charts += figure_html(drawn.tables, chart);
  }
  return charts;
}

ReportSection search_section(const ClosingRecord& result) {
  ReportSection section{.id = "search", .heading = "Progress of the search", .parts = {Drawing{search_charts}}};
  const std::string words = result.search ? families_caption(*result.search) : std::string();
  if (!words.empty())
    section.parts.emplace_back(
        Paragraph{fmt::format("Waveform families that were searched, with the lowest cost of each: {}.", words)});
  return section;
}

/// Returns the drawing of the switch from the side as HTML.
std::string drawn_switch(const ClosingRecord& result) {
  const std::string drawing = device_picture(result.scene);
  if (drawing.empty()) return {};
  return drawing + "<p class=\"below\">Side view, to scale along the beam; heights are exaggerated.</p>\n";
}

ReportSection checks_section(const ClosingRecord& result) {
  ReportSection section{.id = "checks", .heading = "Confirmation by re-runs", .parts = {}};
  // A terminal shows no confirmations (re-runs with other settings) of a best waveform that bounces: there is nothing to
  // confirm.
  if (figure_of_run(result.best, &Metrics::bounce_count) != 0) section.shown = ShownIn::page;
  if (!result.search || result.search->checks.empty()) return section;
  ReportTable table{.head = {"Simulated with"}, .rows = {}};
  for (const Figure& one : leading_figures) table.head.emplace_back(one.name);
  const auto add = [&](const std::string& name, const std::optional<FigureValues>& figures) {
    TableRow& row = table.rows.emplace_back(TableRow{name});
    for (const Figure& one : leading_figures) {
      const double value = figures ? (*figures)[one] : Metrics::unset;
      row.emplace_back(figure_text(one, value, Metrics::unset, figure_of_run(result.baseline(), one.member)));
    }
  };
  add("the settings of the search", result.best.figures);
  for (const ConfirmationRecord& check : result.search->checks) add(check.name, check.figures);
  section.parts = {Paragraph{checks_caption(*result.search)}, drawing_of(table_html(table))};
  return section;
}

/// Splits the name of a waveform parameter into name and unit: "piezo.level_1_V" into "piezo.level_1" and "V".
std::pair<std::string, std::string_view> without_unit(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> units{
      {{"_rad_s", "rad/s"}, {"_rad", "rad"}, {"_s", "s"}, {"_V", "V"}}};
  for (const auto& [suffix, unit] : units) {
    if (name.ends_with(suffix)) return {name.substr(0, name.size() - suffix.size()), unit};
  }
  return {name, ""};
}

/// Returns a number by which waveform parameters sort in the order of the times at which they act.
int place_in_time(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, int>, 8> stems{{{"rise_time", 0},
                                                                   {"start", 0},
                                                                   {"edge", 1},
                                                                   {"amplitude", 2},
                                                                   {"angular_frequency", 3},
                                                                   {"phase", 4},
                                                                   {"duration", 5},
                                                                   {"fade", 6}}};
  const std::size_t digits = name.size() - name.find_last_not_of("0123456789") - 1;
  if (digits > 0 && digits <= 4) {  // sort by the number at the end of the name: level_10 follows level_9
    const int number = 10 * std::stoi(name.substr(name.size() - digits));
    return name.starts_with("level") ? number : number + 1;
  }
  const auto* const found = std::find_if(stems.begin(), stems.end(), [&](const auto& one) { return one.first == name; });
  return found == stems.end() ? 1000000 : found->second;
}

/// Returns the cell with the bounds between which a waveform parameter was searched.
TableCell searched_cell(const ClosingRecord& result, const std::string& parameter, std::string_view unit) {
  const auto box = result.search->bounds.find(parameter);
  if (box == result.search->bounds.end()) return "";
  const auto [low, high] = box->second;
  const double value = result.search->parameters.at(parameter);
  // Largest distance from a bound, as a share of the searched range, at which a parameter counts as lying at the bound.
  constexpr double near = 0.01;
  const char* bound = value - low <= near * (high - low)    ? "at its lower bound"
                      : high - value <= near * (high - low) ? "at its upper bound"
                                                            : "";
  TableCell cell(fmt::format("{} to {}", given_quantity(low, unit, 4), given_quantity(high, unit, 4)));
  if (*bound != 0) cell.html = fmt::format("{} <span class=\"bound\">{}</span>", escaped(cell.text), bound);
  return cell;
}

/// Returns the section with the parameters of the waveform, in the order in which the parameters act.
ReportSection parameters_section(const ClosingRecord& result) {
  ReportSection section{.id = "parameters", .heading = "Parameters of the waveform", .parts = {}, .shown = ShownIn::page};
  if (!result.search || result.search->parameters.empty()) return section;
  struct Row {
    std::string key, drive, name;
    std::string_view unit;
    double value;
  };
  std::vector<Row> rows;
  for (const auto& [key, value] : result.search->parameters) {
    const auto [plain, unit] = without_unit(key);
    const std::size_t dot = plain.rfind('.');
    rows.push_back({key, plain.substr(0, dot == std::string::npos ? 0 : dot),
                    plain.substr(dot == std::string::npos ? 0 : dot + 1), unit, value});
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return std::pair(a.drive, place_in_time(a.name)) < std::pair(b.drive, place_in_time(b.name));
  });
  std::string drawings;
  std::string drive = "\n";
  for (const Row& row : rows) {
    if (row.drive != drive) drawings += parameter_drawing(result, drive = row.drive);
  }
  ReportTable table{.head = {"Parameter", "Value", "Search range"}, .rows = {}};
  for (const Row& row : rows) {
    if (table.rows.size() == most_lines) break;
    constexpr int digits = 5;
    table.rows.push_back({row.drive + (row.drive.empty() ? "" : ".") + row.name, quantity(row.value, row.unit, digits),
                          searched_cell(result, row.key, row.unit)});
  }
  section.parts = {drawing_of(drawings), std::move(table)};
  return section;
}

/// Returns the section with what the user requested and with properties of the device.
ReportSection facts(const ClosingRecord& result) {
  std::string out;
  const auto fact = [&](std::string_view name, std::string value) {
    std::replace(value.begin(), value.end(), '_', ' ');
    if (!value.empty()) out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escaped(value));
  };
  const auto measured = [&](double value, std::string_view unit, int digits) {
    return std::isfinite(value) ? quantity(value, unit, digits) : std::string();
  };
  fact("Status", result.status);
  if (result.search) {
    const SearchRecord& search = *result.search;
    fact("Target", search.target);
    fact("Actuator", search.actuator);
    fact("Waveform", search.waveform);
    fact("Optimizer", search.optimizer);
    fact("Evaluations", std::isfinite(search.evaluations) ? whole(search.evaluations) : "");
    fact("Stopped by", search.termination);
  }
  if (result.pull_in.size() == 1) {  // only for a single actuating electrode: the text for several is too long
    const PullInOfElectrode& voltages = result.pull_in.begin()->second;
    const std::string shift = voltages.static_by_modes ? shift_prose(*voltages.static_by_modes) : "";
    fact("Static pull-in", measured(voltages.static_pull_in, "V", 5) +
                               (shift.empty() ? shift : fmt::format(" (more modes change it by {})", shift)));
    fact("Dynamic pull-in", measured(voltages.dynamic_pull_in, "V", 5));
  }
  std::string modes;
  constexpr std::size_t most_modes = 12;
  for (std::size_t i = 0; i < std::min(result.natural_frequencies.size(), most_modes); ++i) {
    constexpr double two_pi = 6.283185307179586;
    modes += (modes.empty() ? "" : ", ") + quantity(result.natural_frequencies[i] / two_pi, "Hz", 4);
  }
  fact("Natural frequencies", modes);
  if (result.work) {
    fact("Time steps of this run", fmt::format("{}", result.work->steps));
    fact("Computing time of this run", measured(result.work->wall, "s", 3));
  }
  if (!out.empty()) out = "<dl class=\"facts\">\n" + out + "</dl>\n";
  return {.id = "facts", .heading = "About this result", .parts = {drawing_of(out)}};
}

}  // namespace

Document closing_document(const ClosingRecord& result) {
  const Headline line = headline(result);
  Document document{.title = result.title,
                    .origin = result.origin.kind,
                    .headline = line.main,
                    .headline_rest = line.rest,
                    .doubt = checks_agree(result) ? "" : checks_caption(*result.search),
                    .keys = key_numbers(result),
                    .warnings = result.warnings,
                    .draw = [&result] { return picture(result); },
                    .made = made_again(result.origin, {}, result.tolerance)};
  if (result.search) {
    document.made.seed = result.search->seed;
    document.made.reproduce = result.search->reproduce;
    for (const std::string& word : {result.search->target, result.search->actuator}) {
      if (!word.empty()) document.origin += " · " + word;
    }
  }
  const DevicesFindings* const devices = result.devices();
  if (devices != nullptr) {
    document.sections.push_back(choices_section(*devices));
    document.sections.push_back(devices_section(*devices));
  }
  document.sections.push_back({.id = "sketch", .heading = "The switch at rest", .parts = {Drawing{[&result](const Picture&) {
                                                                                  return drawn_switch(result);
                                                                                }}}});
  document.sections.push_back({.id = "charts",
                               .heading = devices != nullptr ? "Closing transient of the nominal design" : "Closing transient",
                               .parts = {Drawing{[&result](const Picture& drawn) { return closing_charts(result, drawn); }}}});
  for (ReportSection& section : std::array{figures_section(result), checks_section(result), search_section(result)}) {
    if (devices != nullptr) section.shown = ShownIn::page;
    document.sections.push_back(std::move(section));
  }
  if (result.search && result.search->seeds) document.sections.push_back(seeds_section(*result.search->seeds));
  document.sections.push_back(parameters_section(result));
  document.sections.push_back(facts(result));
  return document;
}

}  // namespace softland
