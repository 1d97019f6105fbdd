#include "reports/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/printable.h"
#include "reports/chart.h"
#include "reports/closing_clauses.h"
#include "reports/devices_report.h"
#include "reports/escape.h"
#include "reports/figure_text.h"
#include "reports/findings.h"
#include "reports/page.h"
#include "reports/quantity.h"
#include "reports/result_view.h"
#include "reports/seeds_report.h"
#include "reports/sketch.h"

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

// What a landing is judged by: in the table of confirmations, and but for the first above everything else.
constexpr std::array leading_figures{figure_of(&Metrics::initial_contact_time), figure_of(&Metrics::permanent_contact_time),
                                     figure_of(&Metrics::bounce_count), figure_of(&Metrics::major_bounce_height),
                                     figure_of(&Metrics::impact_velocity)};

std::string key_number(const Result& result, const Figure& shown) {
  const ResultRun &own = result.best, &step = result.baseline;
  const auto words = [&](const ResultRun& run, const ResultRun& beside) {
    const std::string reason = missing_reason(run, shown);
    return reason.empty() ? quantity_beside(figure_of_run(run, shown.member), figure_of_run(beside, shown.member), shown.unit)
                          : reason;
  };
  std::string out =
      fmt::format("<div class=\"key\"><dt>{}</dt><dd>", capitalised(std::string(shown.also.empty() ? shown.name : shown.also)));
  if (result.is_search && step.figures)
    out += fmt::format("<span class=\"before\">{} <span aria-label=\"becomes\">→</span></span> ", words(step, own));
  out += fmt::format("<span class=\"after{}\">{}</span>", missing_reason(own, shown).empty() ? "" : " words", words(own, step));
  if (const Change changed = figure_change(step, own, shown); !changed.words.empty()) {
    out += fmt::format("<span class=\"change {}\">{}</span>", verdict_class(changed.verdict), changed.words);
  }
  return out + "</dd></div>\n";
}

std::string key_numbers(const Result& result) {
  if (!result.baseline.figures && !missing_reason(result.best, leading_figures.front()).empty()) return {};
  std::string out;
  for (const Figure& one : std::span(leading_figures).subspan(1)) out += key_number(result, one);
  return out;
}

/// What every drive demands of its source, where there are several.
void add_drive_rows(std::vector<TableRow>& rows, const Result& result, bool pair, bool estimated) {
  if (result.best.waveforms.size() < 2) return;
  for (const auto& [drive, found] : result.best.waveforms) {
    const DriveScale scale = drive_scale(drive);
    if (scale.unit.empty()) continue;  // a factor has no source
    const DriveDemand own = drive_demand(found, scale.rest);
    const DriveDemand step = drive_demand(waveform(result.baseline, drive), scale.rest);
    const auto add = [&, name = &drive](const Figure& what, const std::string& value, const std::string& before) {
      TableRow& row = rows.emplace_back(TableRow{fmt::format("{}, {}", what.name, escaped(*name))});
      if (pair) row.insert(row.end(), {before, ""});
      row.emplace_back(value, "own");
      if (pair) row.emplace_back("");
      if (estimated) row.emplace_back("");
    };
    const auto slew = [](double value) { return std::isinf(value) ? std::string("jumps") : quantity(value, "V/s"); };
    add(figure_of(&Metrics::peak_voltage), quantity(own.peak(), "V", 4), quantity(step.peak(), "V", 4));
    add(figure_of(&Metrics::peak_slew), slew(own.slew), slew(step.slew));
  }
}

TableRow figure_row(const Result& result, const Figure& one, bool pair, bool estimated) {
  const double own = figure_of_run(result.best, one.member), step = figure_of_run(result.baseline, one.member);
  const double error = result.best.errors[one];
  TableRow row{one.label()};
  if (pair) row.insert(row.end(), {figure_text(one, step, result.baseline.errors[one], own), goal_text(result, one)});
  row.emplace_back(figure_text(one, own, error, step), "own");
  if (pair) {
    const Change changed = figure_change(result.baseline, result.best, one);
    row.emplace_back(changed.words, "change " + verdict_class(changed.verdict));
  }
  if (estimated) {
    constexpr double ill = 0.1;  // an error above a tenth of the figure
    const std::string cloud = cloud_text(result, one);
    const std::string stated = error_text(one, own, error);
    const bool is_hidden = stated.starts_with('<');  // below the last digit that is shown
    const bool is_ill = !cloud.empty() || (!is_hidden && error > ill * std::abs(own));
    row.emplace_back((!cloud.empty() ? cloud : stated) + (is_ill ? " <span class=\"note\">ill-conditioned</span>" : ""));
  }
  return row;
}

std::string figures_table(const Result& result) {
  if (!result.best.figures && !result.baseline.figures) return {};
  const bool pair = result.is_search && result.baseline.figures;
  const bool estimated = std::any_of(all_figures.begin(), all_figures.end(),
                                     [&](const Figure& one) { return std::isfinite(result.best.errors[one]); });
  std::string out;
  if (result.goal_met) out += fmt::format("<p>The goal is {}.</p>\n", *result.goal_met ? "met" : "not met");
  if (const std::string words = limit_words(result); !words.empty()) out += "<p>" + escaped(words) + "</p>\n";
  TableRow head{"Figure"};
  if (pair) head.insert(head.end(), {"Plain step", "Goal", "Softland", "Change"});
  if (!pair) head.emplace_back("Value");
  if (estimated) head.emplace_back(error_heading(result));
  std::vector<TableRow> rows;
  for (const Figure& one : all_figures) {
    const bool known =
        !std::isnan(figure_of_run(result.best, one.member)) || !std::isnan(figure_of_run(result.baseline, one.member));
    if (known) rows.push_back(figure_row(result, one, pair, estimated));
  }
  add_drive_rows(rows, result, pair, estimated);
  out += table_html(head, rows);
  if (const std::string words = certificate_caption(result); !words.empty()) out += fmt::format("<p>{}</p>\n", escaped(words));
  if (const std::string words = robust_caption(result); !words.empty()) out += fmt::format("<p>{}</p>\n", escaped(words));
  return section("figures", "Figures", out);
}

std::string charts(const Picture& drawn) {
  std::string time_charts;
  std::string search;
  for (const Chart& chart : drawn.charts) {
    (chart.group.empty() ? search : time_charts) += figure_html(drawn.tables, chart);
  }
  std::string out;
  if (!time_charts.empty()) {
    out +=
        "<section id=\"charts\"><h2>The closing</h2>\n<div class=\"tools\" hidden><span role=\"group\" aria-label=\"Time shown\">"
        "<button type=\"button\" data-view=\"home\" aria-pressed=\"true\">Overview</button>"
        "<button type=\"button\" data-view=\"landing\" aria-pressed=\"false\">Landing</button>"
        "<button type=\"button\" data-view=\"whole\" aria-pressed=\"false\">Whole window</button></span>"
        "<span class=\"hint\">Drag to zoom, double-click to go back. With a chart focused: ← → read, + − zoom, 0 "
        "back.</span></div>\n" +
        time_charts + "</section>\n";
  }
  if (!search.empty()) out += "<section id=\"search\"><h2>The search</h2>\n" + search + "</section>\n";
  return out;
}

/// The switch from the side.
std::string drawn_switch(const Result& result) {
  const std::string drawing = sketch(result.scene);
  if (drawing.empty()) return {};
  return "<section id=\"sketch\"><h2>The switch at rest</h2>\n" + drawing +
         "<p class=\"below\">From the side: to scale along the beam, heights exaggerated.</p></section>\n";
}

std::string list_of(const std::vector<std::string>& lines, std::string_view heading, std::string_view id) {
  if (lines.empty()) return {};
  std::string out = fmt::format("<section id=\"{}\"><h2>{}</h2>\n<ul>\n", id, heading);
  std::size_t shown = 0;
  for (const std::string& line : lines) {
    if (shown++ == most_lines) {
      out += fmt::format("<li>… and {} more</li>\n", lines.size() - most_lines);
      break;
    }
    out += fmt::format("<li>{}</li>\n", escaped(shortened(printable_line(line))));
  }
  return out + "</ul></section>\n";
}

std::string checks_table(const Result& result) {
  if (result.checks.empty()) return {};
  TableRow head{"Simulated with"};
  for (const Figure& one : leading_figures) head.emplace_back(one.name);
  std::vector<TableRow> rows;
  const auto add = [&](const std::string& name, const std::optional<FigureValues>& figures) {
    TableRow& row = rows.emplace_back(TableRow{escaped(name)});
    for (const Figure& one : leading_figures) {
      const double value = figures ? (*figures)[one] : Metrics::unset;
      row.emplace_back(figure_text(one, value, Metrics::unset, figure_of_run(result.baseline, one.member)));
    }
  };
  add("as searched", result.best.figures);
  for (const ResultCheck& check : result.checks) add(check.name, check.figures);
  return section("checks", "Confirmations", "<p>" + escaped(checks_caption(result)) + "</p>\n" + table_html(head, rows));
}

/// "piezo.level_1_V" as "piezo.level_1" and "V".
std::pair<std::string, std::string_view> without_unit(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> units{
      {{"_rad_s", "rad/s"}, {"_rad", "rad"}, {"_s", "s"}, {"_V", "V"}}};
  for (const auto& [suffix, unit] : units) {
    if (name.ends_with(suffix)) return {name.substr(0, name.size() - suffix.size()), unit};
  }
  return {name, ""};
}

/// Where a parameter acts in its waveform: the numbers of two parameters sort as the times from which they act.
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
  if (digits > 0 && digits <= 4) {  // the tenth level comes after the ninth
    const int number = 10 * std::stoi(name.substr(name.size() - digits));
    return name.starts_with("level") ? number : number + 1;
  }
  const auto* const found = std::find_if(stems.begin(), stems.end(), [&](const auto& one) { return one.first == name; });
  return found == stems.end() ? 1000000 : found->second;
}

/// The box that a parameter was searched in.
std::string searched_words(const Result& result, const std::string& parameter, std::string_view unit) {
  const auto box = result.bounds.find(parameter);
  if (box == result.bounds.end()) return {};
  const auto [low, high] = box->second;
  const double value = result.parameters.at(parameter);
  constexpr double near = 0.01;  // of the box
  const char* bound = value - low <= near * (high - low)    ? "at its lower bound"
                      : high - value <= near * (high - low) ? "at its upper bound"
                                                            : "";
  return fmt::format("{} to {}{}", given_quantity(low, unit, 4), given_quantity(high, unit, 4),
                     *bound ? fmt::format(" <span class=\"bound\">{}</span>", bound) : "");
}

/// The parameters in the order in which they act.
std::string parameters_table(const Result& result) {
  if (result.parameters.empty()) return {};
  struct Row {
    std::string key, drive, name;
    std::string_view unit;
    double value;
  };
  std::vector<Row> rows;
  for (const auto& [key, value] : result.parameters) {
    const auto [plain, unit] = without_unit(key);
    const std::size_t dot = plain.rfind('.');
    rows.push_back({key, plain.substr(0, dot == std::string::npos ? 0 : dot),
                    plain.substr(dot == std::string::npos ? 0 : dot + 1), unit, value});
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return std::pair(a.drive, place_in_time(a.name)) < std::pair(b.drive, place_in_time(b.name));
  });
  std::string out;
  std::string drive = "\n";
  for (const Row& row : rows) {
    if (row.drive != drive) out += parameter_drawing(result, drive = row.drive);
  }
  std::vector<TableRow> cells;
  for (const Row& row : rows) {
    if (cells.size() == most_lines) break;
    constexpr int digits = 5;
    cells.push_back({escaped(row.drive) + (row.drive.empty() ? "" : ".") + escaped(row.name),
                     quantity(row.value, row.unit, digits), searched_words(result, row.key, row.unit)});
  }
  return section("parameters", "The waveform found", out + table_html({"Parameter", "Value", "Searched"}, cells));
}

/// What was asked for, and what the device is like.
std::string facts(const Result& result) {
  std::string out;
  const auto fact = [&](std::string_view name, std::string value) {
    std::replace(value.begin(), value.end(), '_', ' ');
    if (!value.empty()) out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escaped(value));
  };
  const auto measured = [&](double value, std::string_view unit, int digits) {
    return std::isfinite(value) ? quantity(value, unit, digits) : std::string();
  };
  fact("Status", result.status);
  fact("Target", result.target);
  fact("Actuator", result.actuator);
  fact("Waveform", result.waveform);
  fact("Families, least cost", families_caption(result));
  fact("Optimizer", result.optimizer);
  fact("Evaluations", std::isfinite(result.evaluations) ? whole(result.evaluations) : "");
  fact("Ended by", result.termination);
  if (result.pull_in.size() == 1) {  // several do not fit here
    const PullInVoltages& voltages = result.pull_in.begin()->second;
    fact("Static pull-in", measured(voltages.static_pull_in, "V", 5));
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
    fact("Steps of the shown run", fmt::format("{}", result.work->steps));
    fact("Its computing time", measured(result.work->wall, "s", 3));
  }
  return out.empty() ? out
                     : "<section id=\"facts\"><h2>About this result</h2>\n<dl class=\"facts\">\n" + out + "</dl></section>\n";
}

}  // namespace

std::string html_report(const Result& result) {
  const Headline line = headline(result);
  const Picture drawn = picture(result);
  std::string origin = result.is_search ? "optimize" : "simulate";
  for (const std::string& word : {result.target, result.actuator}) {
    if (!word.empty()) origin += " · " + word;
  }
  return page({.title = result.title,
               .origin = origin,
               .headline = line.main,
               .headline_rest = line.rest,
               .doubt = checks_agree(result) ? "" : checks_caption(result),
               .keys = result.devices ? devices_keys(*result.devices) : key_numbers(result),
               .body = (result.devices ? devices_section(*result.devices) : std::string()) + drawn_switch(result) +
                       charts(drawn) + figures_table(result) + checks_table(result) + seeds_section(result.seeds) +
                       list_of(result.warnings, "Warnings", "warnings") + parameters_table(result) + facts(result) +
                       reproduce(result) + scene(result),
               .style = chart_style(),
               .scripts = chart_scripts(drawn)});
}

}  // namespace softland
