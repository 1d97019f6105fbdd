#include "reports/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/printable.h"
#include "base/require.h"
#include "reports/chart.h"
#include "reports/escape.h"
#include "reports/findings.h"
#include "reports/page.h"
#include "reports/quantity.h"
#include "reports/result_view.h"
#include "reports/sketch.h"

namespace softland {
namespace {

using namespace internal;
using nlohmann::json;

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

std::string key_number(const json& result, const Figure& shown) {
  const json& own = best_metrics(result);
  const json& step = baseline_metrics(result);
  const auto words = [&](const json& metrics, const json& beside) {
    const std::string reason = missing_reason(metrics, shown);
    return reason.empty() ? quantity_beside(number(metrics, {shown.key}), number(beside, {shown.key}), shown.unit) : reason;
  };
  std::string out =
      fmt::format("<div class=\"key\"><dt>{}</dt><dd>", capitalised(std::string(shown.also.empty() ? shown.name : shown.also)));
  if (is_optimize(result) && step.is_object())
    out += fmt::format("<span class=\"before\">{} <span aria-label=\"becomes\">→</span></span> ", words(step, own));
  out += fmt::format("<span class=\"after{}\">{}</span>", missing_reason(own, shown).empty() ? "" : " words", words(own, step));
  if (const Change changed = figure_change(step, own, shown); !changed.words.empty()) {
    out += fmt::format("<span class=\"change {}\">{}</span>", verdict_class(changed.verdict), changed.words);
  }
  return out + "</dd></div>\n";
}

std::string key_numbers(const json& result) {
  if (!baseline_metrics(result).is_object() && !missing_reason(best_metrics(result), leading_figures.front()).empty()) return {};
  std::string out;
  for (const Figure& one : std::span(leading_figures).subspan(1)) out += key_number(result, one);
  return out;
}

/// What every drive demands of its source, where there are several.
std::string drive_rows(const json& result, bool pair, bool estimated) {
  const json& found = at(result, {"best", "waveforms"});
  if (!found.is_object() || found.size() < 2) return {};
  std::string out;
  for (const auto& [drive, waveform] : found.items()) {
    const DriveScale scale = drive_scale(drive);
    if (scale.unit.empty()) continue;  // a factor has no source
    const DriveDemand own = drive_demand(waveform, scale.rest);
    const DriveDemand step = drive_demand(at(result, {"baseline", "waveforms", drive}), scale.rest);
    const auto row = [&](const char* what, const std::string& value, const std::string& before) {
      out += fmt::format("<tr><th scope=\"row\">{}, {}</th>", what, escaped(drive));
      if (pair) out += fmt::format("<td>{}</td><td></td>", before);
      out += fmt::format("<td class=\"own\">{}</td>", value);
      if (pair) out += "<td></td>";
      if (estimated) out += "<td></td>";
      out += "</tr>\n";
    };
    const auto slew = [](double value) { return std::isinf(value) ? std::string("jumps") : quantity(value, "V/s"); };
    row("Peak voltage", quantity(own.peak(), "V", 4), quantity(step.peak(), "V", 4));
    row("Peak slew", slew(own.slew), slew(step.slew));
  }
  return out;
}

std::string figures_table(const json& result) {
  const json& own = best_metrics(result);
  const json& step = baseline_metrics(result);
  const json& errors = at(result, {"errors"});
  if (!own.is_object() && !step.is_object()) return {};
  const bool pair = is_optimize(result) && step.is_object();
  const bool estimated =
      errors.is_object() && std::any_of(errors.begin(), errors.end(), [](const json& error) { return error.is_number(); });
  std::string out = "<section id=\"figures\"><h2>Figures</h2>\n";
  if (const auto met = truth(result, {"goal_met"})) out += fmt::format("<p>The goal is {}.</p>\n", *met ? "met" : "not met");
  out += "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">Figure</th>";
  if (pair) out += "<th scope=\"col\">Plain step</th><th scope=\"col\">Goal</th>";
  out += pair ? "<th scope=\"col\">Softland</th><th scope=\"col\">Change</th>" : "<th scope=\"col\">Value</th>";
  if (estimated) out += fmt::format("<th scope=\"col\">{}</th>", error_heading(result));
  out += "</tr></thead><tbody>\n";
  for (const Figure& one : all_figures) {
    if (at(own, {one.key}).is_null() && at(step, {one.key}).is_null()) continue;
    out += fmt::format("<tr><th scope=\"row\">{}</th>", one.label());
    if (pair)
      out += fmt::format("<td>{}</td><td>{}</td>", figure_text(step, at(result, {"baseline", "errors"}), own, one),
                         goal_text(result, one));
    out += fmt::format("<td class=\"own\">{}</td>", figure_text(own, errors, step, one));
    if (pair) {
      const Change changed = figure_change(step, own, one);
      out += fmt::format("<td class=\"change {}\">{}</td>", verdict_class(changed.verdict), changed.words);
    }
    if (estimated) {
      const double error = number(errors, {one.key});
      const double value = number(own, {one.key});
      constexpr double ill = 0.1;  // an error above a tenth of the figure
      const std::string cloud = cloud_text(result, one);
      out += fmt::format("<td>{}{}</td>", !cloud.empty() ? cloud : error_text(own, errors, one),
                         !cloud.empty() || error > ill * std::abs(value) ? " <span class=\"note\">ill-conditioned</span>" : "");
    }
    out += "</tr>\n";
  }
  out += drive_rows(result, pair, estimated);
  out += "</tbody></table></div>\n";
  if (const std::string words = certificate_caption(result); !words.empty()) out += fmt::format("<p>{}</p>\n", escaped(words));
  return out + "</section>\n";
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
std::string drawn_switch(const json& result) {
  const std::string drawing = sketch(result);
  if (drawing.empty()) return {};
  return "<section id=\"sketch\"><h2>The switch at rest</h2>\n" + drawing +
         "<p class=\"below\">From the side: to scale along the beam, heights exaggerated.</p></section>\n";
}

std::string list_of(const json& lines, std::string_view heading, std::string_view id) {
  if (!lines.is_array() || lines.empty()) return {};
  std::string out = fmt::format("<section id=\"{}\"><h2>{}</h2>\n<ul>\n", id, heading);
  std::size_t shown = 0;
  for (const json& line : lines) {
    if (!line.is_string()) continue;
    if (shown++ == most_lines) {
      out += fmt::format("<li>… and {} more</li>\n", lines.size() - most_lines);
      break;
    }
    out += fmt::format("<li>{}</li>\n", escaped(shortened(printable_line(line.get<std::string>()))));
  }
  return out + "</ul></section>\n";
}

std::string checks_table(const json& result) {
  const json& checks = at(result, {"checks"});
  if (!checks.is_array() || checks.empty()) return {};
  std::string out = "<section id=\"checks\"><h2>Confirmations</h2>\n<p>" + escaped(checks_caption(result)) +
                    "</p>\n<div class=\"scroll\"><table><thead><tr><th scope=\"col\">Simulated with</th>";
  for (const Figure& one : leading_figures) out += fmt::format("<th scope=\"col\">{}</th>", one.name);
  out += "</tr></thead><tbody>\n";
  const auto row = [&](const std::string& name, const json& metrics) {
    out += fmt::format("<tr><th scope=\"row\">{}</th>", escaped(name));
    for (const Figure& one : leading_figures)
      out += fmt::format("<td>{}</td>", figure_text(metrics, json(), baseline_metrics(result), one));
    out += "</tr>\n";
  };
  row("as searched", best_metrics(result));
  for (const json& check : checks) row(text(check, {"name"}), at(check, {"metrics"}));
  return out + "</tbody></table></div></section>\n";
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
  if (!name.empty() && name.back() >= '1' && name.back() <= '9') {
    const int number = 10 * (name.back() - '0');
    return name.starts_with("level") ? number : number + 1;
  }
  const auto* const found = std::find_if(stems.begin(), stems.end(), [&](const auto& one) { return one.first == name; });
  return found == stems.end() ? 1000 : found->second;
}

/// The parameters in the order in which they act, with the box they were searched in.
std::string parameters_table(const json& result) {
  const json& parameters = at(result, {"best", "parameters"});
  if (!parameters.is_object() || parameters.empty()) return {};
  struct Row {
    std::string drive, name;
    std::string_view unit;
    const json* value;
    const json* bounds;
  };
  std::vector<Row> rows;
  for (const auto& [key, value] : parameters.items()) {
    const auto [plain, unit] = without_unit(key);
    const std::size_t dot = plain.rfind('.');
    rows.push_back({plain.substr(0, dot == std::string::npos ? 0 : dot), plain.substr(dot == std::string::npos ? 0 : dot + 1),
                    unit, &value, &at(result, {"best", "bounds", key})});
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return std::pair(a.drive, place_in_time(a.name)) < std::pair(b.drive, place_in_time(b.name));
  });
  std::string out = "<section id=\"parameters\"><h2>The waveform found</h2>\n";
  std::string drive = "\n";
  for (const Row& row : rows) {
    if (row.drive != drive) out += parameter_drawing(result, drive = row.drive);
  }
  out +=
      "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">Parameter</th><th scope=\"col\">Value</th><th "
      "scope=\"col\">Searched</th></tr></thead><tbody>\n";
  std::size_t shown = 0;
  for (const Row& row : rows) {
    if (shown++ == most_lines) break;
    constexpr int digits = 5;
    const double value = number(*row.value);
    const std::string words = std::isfinite(value)     ? quantity(value, row.unit, digits)
                              : row.value->is_string() ? row.value->get<std::string>()
                                                       : row.value->dump();
    std::string searched;
    if (row.bounds->is_array() && row.bounds->size() == 2) {
      const double low = number((*row.bounds)[0]), high = number((*row.bounds)[1]);
      constexpr double near = 0.01;  // of the box
      const char* bound = value - low <= near * (high - low)    ? "at its lower bound"
                          : high - value <= near * (high - low) ? "at its upper bound"
                                                                : "";
      searched = fmt::format("{} to {}{}", given_quantity(low, row.unit, 4), given_quantity(high, row.unit, 4),
                             *bound ? fmt::format(" <span class=\"bound\">{}</span>", bound) : "");
    }
    out += fmt::format("<tr><th scope=\"row\">{}{}{}</th><td>{}</td><td>{}</td></tr>\n", escaped(row.drive),
                       row.drive.empty() ? "" : ".", escaped(row.name), escaped(words), searched);
  }
  return out + "</tbody></table></div></section>\n";
}

/// What was asked for, and what the device is like.
std::string facts(const json& result) {
  std::string out;
  const auto fact = [&](std::string_view name, const std::string& value) {
    if (!value.empty()) out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escaped(value));
  };
  const auto words = [&](std::string_view key) {
    std::string value = any(result, {key});
    std::replace(value.begin(), value.end(), '_', ' ');
    return value;
  };
  const auto measured = [&](std::initializer_list<std::string_view> path, std::string_view unit, int digits) {
    const double value = number(result, path);
    return std::isfinite(value) ? quantity(value, unit, digits) : std::string();
  };
  fact("Status", words("status"));
  fact("Target", words("target"));
  fact("Actuator", words("actuator"));
  fact("Waveform", words("waveform"));
  fact("Optimizer", words("optimizer"));
  fact("Evaluations", words("evaluations"));
  fact("Budget", words("budget"));
  fact("Ended by", words("termination"));
  fact("Static pull-in", measured({"pull_in", "static_V"}, "V", 5));
  fact("Dynamic pull-in", measured({"pull_in", "dynamic_V"}, "V", 5));
  std::string modes;
  const json& frequencies = at(result, {"natural_frequencies_rad_s"});
  if (frequencies.is_array()) {
    constexpr double two_pi = 6.283185307179586;
    for (std::size_t i = 0; i < std::min<std::size_t>(frequencies.size(), 12); ++i) {
      modes += (modes.empty() ? "" : ", ") + quantity(number(frequencies[i]) / two_pi, "Hz", 4);
    }
  }
  fact("Natural frequencies", modes);
  fact("Steps of the shown run", any(result, {"work", "steps"}));
  fact("Its computing time", measured({"work", "wall_s"}, "s", 3));
  return out.empty() ? out
                     : "<section id=\"facts\"><h2>About this result</h2>\n<dl class=\"facts\">\n" + out + "</dl></section>\n";
}

}  // namespace

std::string html_report(const json& result) {
  require(result.is_object(), "html_report: the result is not a JSON object");
  const Headline line = headline(result);
  const Picture drawn = picture(result);
  const std::string title = text(result, {"title"});
  std::string origin = is_optimize(result) ? "optimize" : "simulate";
  for (const char* key : {"target", "actuator"}) {
    if (const std::string word = text(result, {key}); !word.empty()) origin += " · " + word;
  }
  return page({.title = title,
               .origin = origin,
               .headline = line.main,
               .headline_rest = line.rest,
               .doubt = checks_agree(result) ? "" : checks_caption(result),
               .keys = key_numbers(result),
               .body = drawn_switch(result) + charts(drawn) + figures_table(result) + checks_table(result) +
                       list_of(at(result, {"warnings"}), "Warnings", "warnings") + parameters_table(result) + facts(result) +
                       reproduce(result) + scene(result),
               .style = chart_style(),
               .scripts = chart_scripts(drawn)});
}

}  // namespace softland
