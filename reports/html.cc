#include "reports/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/require.h"
#include "reports/chart.h"
#include "reports/escape.h"
#include "reports/findings.h"
#include "reports/page.h"
#include "reports/page_files.h"
#include "reports/quantity.h"
#include "reports/result_view.h"

namespace softland {
namespace {

using namespace internal;
using nlohmann::json;

/// Rows per curve in the page: several times the pixels of a wide screen, so that zooming shows more, at about 100 kB a curve.
constexpr std::size_t rows_per_curve = 6000;
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

const Figure& figure(std::string_view key) {
  return *std::find_if(figures().begin(), figures().end(), [&](const Figure& one) { return one.key == key; });
}

std::string key_number(const json& result, std::string_view key, std::string_view label) {
  const Figure& shown = figure(key);
  const json& own = best_metrics(result);
  const json& step = baseline_metrics(result);
  const auto words = [&](const json& metrics, const json& beside) {
    const std::string reason = missing_reason(metrics, key);
    return reason.empty() ? quantity_beside(number(metrics, {key}), number(beside, {key}), shown.unit) : reason;
  };
  std::string out = fmt::format("<div class=\"key\"><dt>{}</dt><dd>", label);
  if (is_optimize(result) && step.is_object())
    out += fmt::format("<span class=\"before\">{} <span aria-label=\"becomes\">→</span></span> ", words(step, own));
  out += fmt::format("<span class=\"after{}\">{}</span>", missing_reason(own, key).empty() ? "" : " words", words(own, step));
  if (const Change changed = figure_change(step, own, shown); !changed.words.empty()) {
    out += fmt::format("<span class=\"change {}\">{}</span>", verdict_class(changed.verdict), changed.words);
  }
  return out + "</dd></div>\n";
}

std::string key_numbers(const json& result) {
  if (!baseline_metrics(result).is_object() && !missing_reason(best_metrics(result), "initial_contact_time_s").empty()) return {};
  return key_number(result, "permanent_contact_time_s", "Settling time") + key_number(result, "bounce_count", "Rebounds") +
         key_number(result, "major_bounce_height_m", "Highest rebound") +
         key_number(result, "impact_velocity_m_s", "Impact speed");
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
  if (estimated) out += "<th scope=\"col\">Estimated error</th>";
  out += "</tr></thead><tbody>\n";
  for (const Figure& one : figures()) {
    if (at(own, {one.key}).is_null() && at(step, {one.key}).is_null()) continue;
    out += fmt::format("<tr><th scope=\"row\">{}</th>", one.label);
    if (pair)
      out += fmt::format("<td>{}</td><td>{}</td>", figure_text(step, at(result, {"baseline", "errors"}), own, one),
                         goal_text(result, one.key));
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
  out += "</tbody></table></div>\n";
  if (const std::string words = certificate_caption(result); !words.empty()) out += fmt::format("<p>{}</p>\n", escaped(words));
  return out + "</section>\n";
}

std::string charts(const Picture& drawn) {
  std::string time_charts;
  std::string search;
  for (const Chart& chart : drawn.charts) {
    std::string words = fmt::format("<figure id=\"figure-{0}\"><h3>{1}</h3>\n<div class=\"live\" data-chart=\"{0}\"></div>\n",
                                    chart.id, escaped(chart.title));
    words += still_picture(drawn.tables, chart);
    words += fmt::format("<figcaption>{}</figcaption></figure>\n", escaped(chart.caption));
    (chart.group.empty() ? search : time_charts) += words;
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
    out += fmt::format("<li>{}</li>\n", escaped(shortened(line.get<std::string>())));
  }
  return out + "</ul></section>\n";
}

std::string checks_table(const json& result) {
  const json& checks = at(result, {"checks"});
  if (!checks.is_array() || checks.empty()) return {};
  const std::vector<std::string_view> keys{"initial_contact_time_s", "permanent_contact_time_s", "bounce_count",
                                           "major_bounce_height_m", "impact_velocity_m_s"};
  std::string out = "<section id=\"checks\"><h2>Confirmations</h2>\n<p>" + escaped(checks_caption(result)) +
                    "</p>\n<div class=\"scroll\"><table><thead><tr><th scope=\"col\">Simulated with</th>";
  for (const char* label : {"First contact", "Permanent contact", "Rebounds", "Highest rebound", "Impact speed"}) {
    out += fmt::format("<th scope=\"col\">{}</th>", label);
  }
  out += "</tr></thead><tbody>\n";
  const auto row = [&](const std::string& name, const json& metrics) {
    out += fmt::format("<tr><th scope=\"row\">{}</th>", escaped(name));
    for (const std::string_view key : keys)
      out += fmt::format("<td>{}</td>", figure_text(metrics, json(), baseline_metrics(result), figure(key)));
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

std::string parameters_table(const json& result) {
  const json& parameters = at(result, {"best", "parameters"});
  if (!parameters.is_object() || parameters.empty()) return {};
  std::string out =
      "<section id=\"parameters\"><h2>The waveform found</h2>\n<div class=\"scroll\"><table><thead><tr><th "
      "scope=\"col\">Parameter</th><th scope=\"col\">Value</th></tr></thead><tbody>\n";
  std::size_t shown = 0;
  for (const auto& [name, value] : parameters.items()) {
    if (shown++ == most_lines) break;
    const auto [plain, unit] = without_unit(name);
    const std::string words = value.is_number()   ? quantity(value.get<double>(), unit, 5)
                              : value.is_string() ? value.get<std::string>()
                                                  : value.dump();
    out += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escaped(plain), escaped(words));
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
  const std::string scripts =
      filled(page_file("page/scripts.html"), {{"chart_js", std::string(page_file("uplot/uPlot.iife.min.js"))},
                                              {"chart_licence", std::string(page_file("uplot/LICENSE"))},
                                              {"js", std::string(page_file("page/page.js"))},
                                              {"data", script_json(chart_json(drawn, rows_per_curve))}});
  return page({.title = title,
               .origin = origin,
               .headline = line.main,
               .headline_rest = line.rest,
               .doubt = checks_agree(result) ? "" : checks_caption(result),
               .keys = key_numbers(result),
               .body = charts(drawn) + figures_table(result) + checks_table(result) +
                       list_of(at(result, {"warnings"}), "Warnings", "warnings") + parameters_table(result) + facts(result) +
                       reproduce(result) + scene(result),
               .style = std::string(page_file("uplot/uPlot.min.css")),
               .scripts = scripts});
}

}  // namespace softland
