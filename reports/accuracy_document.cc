// Diagrams and document of `softland accuracy`, which compares errors and computing times of integrators.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "document/chart.h"
#include "document/quantity.h"
#include "document/svg.h"
#include "reports/accuracy_report.h"
#include "reports/closing_captions.h"
#include "reports/origin.h"

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
using internal::setting_text;
using internal::symbols;

Chart logarithmic_chart(std::string id, std::string title, std::string x_label, std::string x_unit, int height) {
  Chart chart;
  chart.id = std::move(id);
  chart.title = std::move(title);
  chart.x_column = "x";
  chart.x_label = std::move(x_label);
  chart.x_unit = std::move(x_unit);
  chart.y_label = "Relative error";
  chart.scale = chart.x_scale = internal::AxisScale::logarithmic;
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

// Returns the points (computing time, largest relative error of the well-conditioned figures of merit) of an integrator, one
// per tolerance.
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
      "There is one curve per integrator; its dots are tolerances, a factor of ten apart. Settings at the lower left are both "
      "fast and accurate.";
  for (std::size_t i = 0; i < all_integrators.size(); ++i) {
    add_curve(drawn, work, std::string(to_string(all_integrators[i])), pens[i % pens.size()],
              work_precision(study, study.rows, all_integrators[i]));
    if (all_integrators[i] != own) continue;
    for (Mark& mark : work.marks) {  // only the dots of the integrator of `simulate` are labelled with their tolerance
      for (const AccuracyRow& row : study.rows) {
        const bool shown = row.integrator == own && row.points_per_length == own_points(study) && row.seconds == mark.x;
        if (shown && mark.role == pens[i % pens.size()]) mark.text = internal::scientific(row.tolerance);
      }
    }
  }
  keep(drawn, std::move(work));

  // These curves show what a restart at make and break of contact costs the integrator of `simulate`, and the multistep method
  // BDF, which loses its earlier steps at every restart.
  Chart contact = logarithmic_chart("contact", "Largest relative error, with and without restarts at contact", time, "s", 260);
  contact.caption = restart_text(study);
  std::size_t pen = 0;
  for (const Integrator integrator : {own, Integrator::bdf}) {
    for (const auto* rows : {&study.rows, &study.through}) {
      const char* how = rows == &study.through ? ", no restart" : "";
      add_curve(drawn, contact, std::string(to_string(integrator)) + how, pens[pen++], work_precision(study, *rows, integrator));
    }
  }
  if (!study.through.empty()) keep(drawn, std::move(contact));

  Chart points = logarithmic_chart("quadrature", fmt::format("Quadrature: {} at its tightest tolerance", to_string(own)),
                                   "Quadrature points per length", "", 260);
  points.caption = "Error of too few quadrature points, at the tightest tolerance.";
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

// Makes a table of errors and computing costs, with a row per setting of the integrator or the model; `first` is the heading of
// the column with the settings.
ReportTable errors_table(const TableRow& first, const std::vector<const AccuracyRow*>& rows,
                         const std::function<TableRow(const AccuracyRow&)>& setting) {
  ReportTable table{.head = first, .rows = {}};
  for (const Figure& f : studied_figures) table.head.emplace_back(f.symbol);
  table.head.insert(table.head.end(), {"right-hand sides", "time"});
  for (const AccuracyRow* row : rows) {
    TableRow& cells = table.rows.emplace_back(setting(*row));
    if (!row->missing.empty()) {
      cells.emplace_back(row->missing, "missing", studied_figures.size() + 2);
      continue;
    }
    for (const double error : row->errors) cells.emplace_back(error_cell(error));
    cells.emplace_back(fmt::format("{}", row->work.rhs_evaluations));
    cells.emplace_back(internal::quantity(row->seconds, "s"));
  }
  return table;
}

ReportTable by_integrator(const std::vector<const AccuracyRow*>& rows) {
  return errors_table({"Integrator", "Tolerance"}, rows, [](const AccuracyRow& row) {
    return TableRow{std::string(to_string(row.integrator)), internal::scientific(row.tolerance)};
  });
}

std::vector<const AccuracyRow*> all_of(const std::vector<AccuracyRow>& rows) {
  std::vector<const AccuracyRow*> all;
  for (const AccuracyRow& row : rows) all.push_back(&row);
  return all;
}

ReportSection recommendations_section(const AccuracyStudy& study) {
  ReportSection section{.id = "recommendations", .heading = "Fastest settings", .parts = {}};
  if (symbols(study, true).empty()) {
    section.parts.emplace_back(Paragraph{recommendations(study).front()});
    return section;
  }
  const bool has_points = own_points(study).has_value();
  ReportTable table{.head = {"Accuracy wanted", "Integrator", "Tolerance", "Time of a closing"}, .rows = {}};
  if (has_points) table.head.insert(table.head.end() - 1, "Points per length");
  for (const Recommendation& r : study.recommendations) {
    TableRow& cells = table.rows.emplace_back(TableRow{internal::scientific(r.accuracy)});
    if (!r.row) {
      cells.emplace_back("no setting that was tried");
      continue;
    }
    const AccuracyRow& row = study.rows[*r.row];
    cells.emplace_back(to_string(row.integrator));
    cells.emplace_back(internal::scientific(row.tolerance));
    if (has_points) cells.emplace_back(fmt::format("{:g}", *row.points_per_length));
    cells.emplace_back(internal::quantity(row.seconds, "s", 2));
  }
  const std::string ill = symbols(study, false);
  section.parts = {std::move(table),
                   Paragraph{.text = fmt::format("Each row has the fastest setting with which {} are that accurate, at its "
                                                 "tolerance and at every tighter one that was tried.{}",
                                                 symbols(study, true),
                                                 ill.empty() ? "" : " Ill-conditioned figures are left out: " + ill + "."),
                             .is_note = true}};
  return section;
}

ReportSection settings_section(const AccuracyStudy& study) {
  std::vector<const AccuracyRow*> own;
  for (const AccuracyRow& row : study.rows) {
    if (row.points_per_length == own_points(study)) own.push_back(&row);
  }
  std::vector<std::string> values;
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    const double value = studied_figures[i].value(study.reference.figures);
    if (std::isfinite(value))
      values.push_back(fmt::format("{} {} ({})", studied_figures[i].symbol, four_digits(value, studied_figures[i].unit),
                                   error_cell(study.resolution[i])));
  }
  const std::vector<const AccuracyRow*> quadrature = quadrature_rows(study);
  const std::string points = points_text(study.rows.front()),
                    tightest = fmt::format("{} at a tolerance of {}", to_string(study.reference.integrator),
                                           internal::scientific(quadrature.front()->tolerance));
  ReportSection section{
      .id = "settings",
      .heading = "All settings that were tried",
      .parts = {Paragraph{fmt::format("The errors are relative to a reference run ({}, {}): {}. The difference of a second "
                                      "reference is in brackets. Times are medians of processor time.",
                                      setting_text(study.reference), modes_text(study.reference), fmt::join(values, ", "))},
                Paragraph{study.message.empty() ? "" : "The reference: " + study.message + "."},
                SubHeading{"Integrator and tolerance" + (points.empty() ? "" : ", with " + points)}, by_integrator(own),
                SubHeading{"Without a restart at make and break of contact"}, Paragraph{restart_text(study)}}};
  if (!study.through.empty()) section.parts.emplace_back(by_integrator(all_of(study.through)));
  section.parts.emplace_back(SubHeading{"Quadrature, with " + tightest});
  if (points.empty()) {
    section.parts.emplace_back(Paragraph{internal::no_quadrature});
  } else {
    section.parts.emplace_back(errors_table({"Points per length"}, quadrature, [](const AccuracyRow& row) {
      return TableRow{fmt::format("{:g}", *row.points_per_length)};
    }));
  }
  if (study.modes.empty()) return section;
  section.parts.emplace_back(
      SubHeading{fmt::format("Other numbers of modes, with {}: they are other models, not errors", tightest)});
  section.parts.emplace_back(errors_table({"Modes"}, all_of(study.modes),
                                          [](const AccuracyRow& row) { return TableRow{fmt::format("{}", row.modes)}; }));
  return section;
}

ReportSection cloud_section(const AccuracyStudy& study) {
  ReportTable table{.head = {"Figure", "lowest", "median", "highest", "runs", ""}, .rows = {}};
  const auto add = [&](const Figure& f, const Spread& s, bool ill) {
    const auto value = [&](double v) { return s.runs > 0 ? four_digits(v, f.unit) : std::string("—"); };
    table.rows.push_back({f.symbol,
                          value(s.low),
                          value(s.median),
                          value(s.high),
                          fmt::format("{}", s.runs),
                          {ill ? "ill-conditioned" : "", "note"}});
  };
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    if (study.cloud[i].runs > 0) add(studied_figures[i], study.cloud[i], !study.conditioned[i]);
  }
  add(figure_of(&Metrics::permanent_contact_time), study.permanent_contact_time, ill_conditioned(study.permanent_contact_time));
  add(figure_of(&Metrics::bounce_count), study.bounce_count, ill_conditioned(study.bounce_count));
  return {
      .id = "cloud",
      .heading = "Ill-conditioned figures",
      .parts = {std::move(table),
                Paragraph{.text = "The drives of these runs differ by one part in 1e9 to 1e7, less than any source can resolve. "
                                  "Settling time and bounce count are statistics of many such runs, not properties of one run.",
                          .is_note = true}}};
}

std::vector<KeyNumber> reference_keys(const AccuracyStudy& study) {
  std::vector<KeyNumber> keys;
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    const Figure& f = studied_figures[i];
    const double value = f.value(study.reference.figures);
    keys.push_back({.name = f.label(),
                    .value = internal::quantity(value, f.unit, 4),
                    .change = !std::isfinite(value)   ? ""
                              : !study.conditioned[i] ? "ill-conditioned"
                                                      : "known within " + error_cell(study.resolution[i])});
  }
  return keys;
}

// Returns the relative accuracy of the figures of merit that the scene sets in [simulate], or its default.
double asked_accuracy(const Origin& origin) {
  const auto simulate = origin.scene.find("simulate");
  const bool is_written = simulate != origin.scene.end() && simulate->is_object() && simulate->contains("accuracy");
  return is_written && (*simulate)["accuracy"].is_number() ? (*simulate)["accuracy"].get<double>() : SimulateOptions{}.accuracy;
}

// Returns the headline of the report: it compares the accuracy that the scene requests with the nearest accuracy of the study.
std::pair<std::string, std::string> headline(const AccuracyRecord& record) {
  const AccuracyStudy& study = record.found;
  const std::string figures = symbols(study, true);
  if (figures.empty() || study.recommendations.empty()) return {recommendations(study).front(), ""};
  const double asked = std::log(asked_accuracy(record.origin));
  const auto& r =
      *std::min_element(study.recommendations.begin(), study.recommendations.end(), [&](const auto& a, const auto& b) {
        return std::abs(std::log(a.accuracy) - asked) < std::abs(std::log(b.accuracy) - asked);
      });
  if (!r.row) return {fmt::format("No setting that was tried has {} within {}.", figures, internal::scientific(r.accuracy)), ""};
  const AccuracyRow& row = study.rows[*r.row];
  return {fmt::format("A closing with {} within {} takes {}", figures, internal::scientific(r.accuracy),
                      internal::quantity(row.seconds, "s", 2)),
          fmt::format(", with {}.", setting_text(row))};
}

}  // namespace

Document document_of(const AccuracyRecord& record) {
  const AccuracyStudy& study = record.found;
  Document document{.title = title_of(record.origin), .origin = "accuracy", .made = made_again(record.origin)};
  if (study.rows.empty()) {
    document.headline = study.status == Status::no_contact
                            ? "The switch does not touch within the window, so there are no figures to compare."
                            : fmt::format("There is no reference to compare with: {}",
                                          study.message.empty() ? std::string(to_string(study.status)) : study.message);
    return document;
  }
  std::tie(document.headline, document.headline_rest) = headline(record);
  document.keys = reference_keys(study);
  document.draw = [&study] { return picture(study); };
  document.sections = {recommendations_section(study),
                       {.id = "charts", .heading = "Accuracy against computing time", .parts = {internal::all_charts()}},
                       settings_section(study),
                       cloud_section(study)};
  return document;
}

std::string svg_of(const AccuracyRecord& record) {
  const AccuracyStudy& study = record.found;
  const std::string title = title_of(record.origin);
  std::string words = "Dots are tolerances, a factor of ten apart. Fastest setting within";
  for (const Recommendation& r : study.recommendations)
    words += fmt::format(" {}: {}{}", internal::scientific(r.accuracy), recommended(study, r),
                         &r == &study.recommendations.back() ? "." : ";");
  return svg_page(title.empty() ? "Accuracy against computing time" : title + ": accuracy against computing time", words,
                  picture(study));
}

}  // namespace softland
