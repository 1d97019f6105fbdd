// Diagrams and page of `softland accuracy`.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "reports/accuracy_report.h"
#include "reports/accuracy_words.h"
#include "reports/chart.h"
#include "reports/escape.h"
#include "reports/findings.h"
#include "reports/origin.h"
#include "reports/page.h"
#include "reports/quantity.h"
#include "reports/svg.h"

namespace softland {
namespace {

using internal::Chart;
using internal::error_cell;
using internal::four_digits;
using internal::Mark;
using internal::modes_text;
using internal::own_points;
using internal::Picture;
using internal::points_text;
using internal::quadrature_rows;
using internal::recommendations;
using internal::recommended;
using internal::restart_text;
using internal::Role;
using internal::section;
using internal::setting_text;
using internal::symbol_html;
using internal::symbols;
using internal::table_html;
using internal::TableRow;

Chart logarithmic_chart(std::string id, std::string title, std::string x_label, std::string x_unit, int height) {
  Chart chart;
  chart.id = std::move(id);
  chart.title = std::move(title);
  chart.x_column = "x";
  chart.x_label = std::move(x_label);
  chart.x_unit = std::move(x_unit);
  chart.y_label = "Relative error";
  chart.scale = chart.x_scale = internal::Scale::logarithmic;
  chart.height = height;
  return chart;
}

void add_curve(Picture& drawn, Chart& chart, std::string label, Role pen, Points points) {
  std::erase_if(points, [](const auto& p) { return !(p[0] > 0 && p[1] > 0 && std::isfinite(p[1])); });
  if (points.empty()) return;
  std::sort(points.begin(), points.end());
  const std::string name = fmt::format("{}/{}", chart.id, chart.series.size());
  for (const auto& [x, y] : points) {
    drawn.tables[name]["x"].push_back(x);
    drawn.tables[name]["y"].push_back(y);
    chart.marks.push_back({x, y, pen, ""});
  }
  chart.series.push_back({name, "y", std::move(label), pen});
}

void keep(Picture& drawn, Chart chart) {
  if (chart.marks.empty()) return;
  const auto [first, last] =
      std::minmax_element(chart.marks.begin(), chart.marks.end(), [](const Mark& a, const Mark& b) { return a.x < b.x; });
  constexpr double margin = 1.15;
  chart.x_home = chart.x_whole = {first->x / margin, last->x * margin};
  drawn.charts.push_back(std::move(chart));
}

// Error against time, of an integrator at every tolerance.
Points work_precision(const AccuracyStudy& study, const std::vector<AccuracyRow>& rows, Integrator integrator) {
  Points points;
  for (const AccuracyRow& row : rows) {
    if (row.integrator == integrator && row.points_per_length == own_points(study))
      points.push_back({row.seconds, study.worst_error(row)});
  }
  return points;
}

Picture picture(const AccuracyStudy& study) {
  constexpr std::array pens{Role::best, Role::baseline, Role::third, Role::fourth, Role::fifth};
  Picture drawn;
  const Integrator own = study.reference.integrator;
  const std::string time = "Time of one closing", figures = symbols(study, true);

  Chart work = logarithmic_chart("work-precision", "Largest relative error of " + figures, time, "s", 380);
  work.caption =
      "One curve per integrator; the dots of a curve are tolerances, a factor of ten apart. The lower left is where to be.";
  for (std::size_t i = 0; i < all_integrators.size(); ++i) {
    add_curve(drawn, work, std::string(to_string(all_integrators[i])), pens[i % pens.size()],
              work_precision(study, study.rows, all_integrators[i]));
    if (all_integrators[i] != own) continue;
    for (Mark& mark : work.marks) {  // which tolerance is where, said once
      for (const AccuracyRow& row : study.rows) {
        const bool shown = row.integrator == own && row.points_per_length == own_points(study) && row.seconds == mark.x;
        if (shown && mark.role == pens[i % pens.size()]) mark.text = internal::scientific(row.tolerance);
      }
    }
  }
  keep(drawn, std::move(work));

  // The integrator that simulate takes, and the one that loses its history with every restart.
  Chart contact = logarithmic_chart(
      "contact", "Restarted at make and break of contact, or not: largest relative error of " + figures, time, "s", 260);
  contact.caption = restart_text(study);
  std::size_t pen = 0;
  for (const Integrator integrator : {own, Integrator::bdf}) {
    for (const auto* rows : {&study.rows, &study.through}) {
      const char* how = rows == &study.through ? ", not restarted" : "";
      add_curve(drawn, contact, std::string(to_string(integrator)) + how, pens[pen++], work_precision(study, *rows, integrator));
    }
  }
  if (!study.through.empty()) keep(drawn, std::move(contact));

  Chart points = logarithmic_chart("quadrature", fmt::format("Quadrature: {} at its tightest tolerance", to_string(own)),
                                   "Quadrature points per length", "", 260);
  points.caption = "What too few points leave, however tight the tolerance.";
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    if (!study.conditioned[i] || !own_points(study)) continue;
    Points errors;
    for (const AccuracyRow* row : quadrature_rows(study)) {
      if (row->missing.empty()) errors.push_back({*row->points_per_length, row->errors[i]});
    }
    add_curve(drawn, points, std::string(studied_figures[i].symbol), pens[i % pens.size()], std::move(errors));
  }
  keep(drawn, std::move(points));
  return drawn;
}

// Errors and costs of settings; `first` says what a row is.
std::string errors_table(const std::vector<std::string>& first, const std::vector<const AccuracyRow*>& rows,
                         const std::function<std::vector<std::string>(const AccuracyRow&)>& setting) {
  TableRow head(first.begin(), first.end());
  for (const Figure& f : studied_figures) head.emplace_back(symbol_html(f.symbol));
  head.insert(head.end(), {"right-hand sides", "time"});
  std::vector<TableRow> body;
  for (const AccuracyRow* row : rows) {
    const std::vector<std::string> words = setting(*row);
    TableRow& cells = body.emplace_back(words.begin(), words.end());
    if (!row->missing.empty()) {
      cells.emplace_back(internal::escaped(row->missing), "missing", studied_figures.size() + 2);
      continue;
    }
    for (const double error : row->errors) cells.emplace_back(error_cell(error));
    cells.emplace_back(fmt::format("{}", row->work.rhs_evaluations));
    cells.emplace_back(internal::quantity(row->seconds, "s"));
  }
  return table_html(head, body);
}

std::vector<const AccuracyRow*> all_of(const std::vector<AccuracyRow>& rows) {
  std::vector<const AccuracyRow*> all;
  for (const AccuracyRow& row : rows) all.push_back(&row);
  return all;
}

std::string recommendations_html(const AccuracyStudy& study) {
  if (symbols(study, true).empty()) return "<p>" + recommendations(study).front() + "</p>\n";
  const bool has_points = own_points(study).has_value();
  std::vector<TableRow> rows;
  for (const Recommendation& r : study.recommendations) {
    const std::string accuracy = internal::scientific(r.accuracy);
    TableRow cells{accuracy, "nothing that was tried", "", ""};
    if (r.row) {
      const AccuracyRow& row = study.rows[*r.row];
      cells = {accuracy, std::string(to_string(row.integrator)), internal::scientific(row.tolerance),
               internal::quantity(row.seconds, "s", 2)};
    }
    if (has_points) cells.insert(cells.end() - 1, r.row ? fmt::format("{:g}", *study.rows[*r.row].points_per_length) : "");
    rows.push_back(std::move(cells));
  }
  TableRow head{"Accuracy wanted", "Integrator", "Tolerance", "Time of a closing"};
  if (has_points) head.insert(head.end() - 1, "Points per length");
  const std::string ill = symbols(study, false);
  return table_html(head, rows) +
         fmt::format(
             "<p class=\"below\">The quickest setting with which {} are that accurate, there and at every tighter tolerance "
             "tried.{}</p>\n",
             symbols(study, true), ill.empty() ? "" : " Left out, because ill-conditioned here: " + ill + ".");
}

std::string clouds_html(const AccuracyStudy& study) {
  std::vector<TableRow> rows;
  const auto add = [&](const Figure& f, const Spread& s, bool ill) {
    const auto value = [&](double v) { return s.runs > 0 ? four_digits(v, f.unit) : std::string("—"); };
    rows.push_back({symbol_html(f.symbol), value(s.low), value(s.median), value(s.high), fmt::format("{}", s.runs),
                    fmt::format("<span class=\"note\">{}</span>", ill ? "ill-conditioned" : "")});
  };
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    if (study.cloud[i].runs > 0) add(studied_figures[i], study.cloud[i], !study.conditioned[i]);
  }
  add(figure_of(&Metrics::permanent_contact_time), study.permanent_contact_time, ill_conditioned(study.permanent_contact_time));
  add(figure_of(&Metrics::bounce_count), study.bounce_count, ill_conditioned(study.bounce_count));
  return table_html({"Figure", "lowest", "median", "highest", "runs", ""}, rows) +
         "<p class=\"below\">Runs whose drives differ by one part in 1e9 to 1e7, which nobody could notice. Permanent contact "
         "time and "
         "bounce count are properties of such a cloud, not of one run.</p>\n";
}

std::string charts_html(const Picture& drawn) {
  std::string out;
  for (const Chart& chart : drawn.charts) out += internal::figure_html(drawn.tables, chart);
  return out;
}

std::string reference_keys(const AccuracyStudy& study) {
  std::string out;
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    const Figure& f = studied_figures[i];
    const double value = f.value(study.reference.figures);
    const bool has_index = f.symbol.find('_') != std::string_view::npos;
    out += internal::key_html(std::string(f.name) + (has_index ? ", " + symbol_html(f.symbol) : ""),
                              internal::quantity(value, f.unit, 4),
                              !std::isfinite(value)   ? ""
                              : !study.conditioned[i] ? "ill-conditioned"
                                                      : "known to " + error_cell(study.resolution[i]));
  }
  return out;
}

// What the accuracy takes that is nearest to the one the scene asks for.
std::pair<std::string, std::string> headline(const PreparedScene& prepared, const AccuracyStudy& study) {
  const std::string figures = symbols(study, true);
  if (figures.empty() || study.recommendations.empty()) return {recommendations(study).front(), ""};
  const double asked = std::log(prepared.scene.simulate.accuracy);
  const auto& r =
      *std::min_element(study.recommendations.begin(), study.recommendations.end(), [&](const auto& a, const auto& b) {
        return std::abs(std::log(a.accuracy) - asked) < std::abs(std::log(b.accuracy) - asked);
      });
  if (!r.row) return {fmt::format("Nothing that was tried has {} within {}.", figures, internal::scientific(r.accuracy)), ""};
  const AccuracyRow& row = study.rows[*r.row];
  return {fmt::format("A closing with {} within {} takes {}", figures, internal::scientific(r.accuracy),
                      internal::quantity(row.seconds, "s", 2)),
          fmt::format(", with {}.", setting_text(row))};
}

}  // namespace

std::string accuracy_html(const PreparedScene& prepared, const AccuracyStudy& study, const Provenance& provenance) {
  const auto integrator = [](const AccuracyRow& row) {
    return std::vector<std::string>{std::string(to_string(row.integrator)), internal::scientific(row.tolerance)};
  };
  std::vector<const AccuracyRow*> own;
  for (const AccuracyRow& row : study.rows) {
    if (row.points_per_length == own_points(study)) own.push_back(&row);
  }
  std::string settings = fmt::format(
      "<p>Relative errors of the delivered figures against the reference: {}, {}. {}Times are medians of processor time.</p>\n",
      setting_text(study.reference), modes_text(study.reference),
      study.message.empty() ? "" : "The reference: " + internal::escaped(study.message) + ". ");
  const std::string points = points_text(study.rows.front());
  settings += fmt::format("<h3>Integrator and tolerance{}{}</h3>\n", points.empty() ? "" : ", with ", points) +
              errors_table({"Integrator", "Tolerance"}, own, integrator);
  settings += "<h3>The same without a restart at make and break of contact</h3>\n";
  settings += study.through.empty()
                  ? "<p>" + restart_text(study) + "</p>\n"
                  : "<details><summary>" + restart_text(study) + "</summary>\n" +
                        errors_table({"Integrator", "Tolerance"}, all_of(study.through), integrator) + "</details>\n";
  const std::vector<const AccuracyRow*> quadrature = quadrature_rows(study);
  const std::string tightest = fmt::format("{} at a tolerance of {}", to_string(study.reference.integrator),
                                           internal::scientific(quadrature.front()->tolerance));
  settings += fmt::format("<h3>Quadrature, with {}</h3>\n", tightest);
  settings += points.empty() ? fmt::format("<p>{}</p>\n", internal::no_quadrature)
                             : errors_table({"Points per length"}, quadrature, [](const AccuracyRow& row) {
                                 return std::vector{fmt::format("{:g}", *row.points_per_length)};
                               });
  if (!study.modes.empty()) {
    settings += fmt::format("<h3>Another number of modes, with {}: another model, not an error</h3>\n", tightest) +
                errors_table({"Modes"}, all_of(study.modes),
                             [](const AccuracyRow& row) { return std::vector{fmt::format("{}", row.modes)}; });
  }
  const Picture drawn = picture(study);
  const auto [main, rest] = headline(prepared, study);
  const Result result = internal::origin(prepared, provenance.command);
  return internal::page({.title = prepared.scene.title,
                         .origin = "accuracy",
                         .headline = main,
                         .headline_rest = rest,
                         .keys = reference_keys(study),
                         .body = section("recommendations", "Quickest settings", recommendations_html(study)) +
                                 section("charts", "What accuracy costs", charts_html(drawn)) +
                                 section("settings", "Every setting that was tried", settings) +
                                 section("cloud", "What no setting can tell", clouds_html(study)) + internal::reproduce(result) +
                                 internal::scene(result),
                         .style = internal::chart_style(),
                         .scripts = internal::chart_scripts(drawn)});
}

std::string accuracy_svg(const std::string& title, const AccuracyStudy& study) {
  std::string words = "Dots are tolerances, a factor of ten apart. Quickest within";
  for (const Recommendation& r : study.recommendations)
    words += fmt::format(" {}: {}{}", internal::scientific(r.accuracy), recommended(study, r),
                         &r == &study.recommendations.back() ? "." : ";");
  return svg_page(title.empty() ? "What accuracy costs" : title + ": what accuracy costs", words, picture(study));
}

}  // namespace softland
