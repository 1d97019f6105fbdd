#include "reports/accuracy_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "reports/accuracy_words.h"
#include "reports/findings.h"
#include "reports/json_number.h"
#include "reports/origin.h"
#include "reports/quantity.h"
#include "reports/result_json.h"
#include "reports/text.h"
#include "reports/text_table.h"

namespace softland {
namespace {

using internal::error_cell;
using internal::four_digits;
using internal::json_number;
using internal::modes_text;
using internal::own_points;
using internal::points_text;
using internal::quadrature_rows;
using internal::recommendations;
using internal::restart_text;
using internal::setting_text;
using internal::symbols;
using internal::TextRow;
using nlohmann::json;

json errors_json(const FigureErrors& errors) {
  json all = json::object();
  for (std::size_t i = 0; i < errors.size(); ++i) all[std::string(studied_figures[i].key)] = json_number(errors[i]);
  return all;
}

json setting_json(const AccuracyRow& row) {
  return {{"integrator", to_string(row.integrator)},
          {"tolerance", row.tolerance},
          {"points_per_length", row.points_per_length ? json(*row.points_per_length) : json(nullptr)},
          {"modes", row.modes}};
}

json row_json(const AccuracyRow& row) {
  json j = setting_json(row);
  if (!row.missing.empty()) {
    j["missing"] = row.missing;
    return j;
  }
  j["relative_errors"] = errors_json(row.errors);
  j["metrics"] = metrics_json(row.figures);
  j["steps"] = row.work.steps;
  j["rhs_evaluations"] = row.work.rhs_evaluations;
  j["cpu_s"] = json_number(row.seconds);
  j["runs"] = row.runs;
  return j;
}

json rows_json(const std::vector<AccuracyRow>& rows) {
  json all = json::array();
  for (const AccuracyRow& row : rows) all.push_back(row_json(row));
  return all;
}

json spread_json(const Spread& s) {
  return {{"low", json_number(s.low)}, {"median", json_number(s.median)}, {"high", json_number(s.high)}, {"runs", s.runs}};
}

TextRow row_of(TextRow setting, const AccuracyRow& row) {
  if (!row.missing.empty()) {
    setting.push_back("    " + row.missing);
    return setting;
  }
  for (const double error : row.errors) setting.push_back(error_cell(error));
  setting.push_back(fmt::format("{}", row.work.rhs_evaluations));
  setting.push_back(internal::quantity(row.seconds, "s"));
  return setting;
}

// Errors and costs beside two words of setting.
std::string errors_table(const char* what, const char* of_it, const std::vector<TextRow>& rows) {
  TextRow heads{of_it};
  for (const Figure& f : studied_figures) heads.emplace_back(f.symbol);
  heads.insert(heads.end(), {"rhs", "time"});
  std::vector<internal::TextColumn> columns = internal::number_columns(heads, 11);
  columns.insert(columns.begin(), {.head = what, .width = 16, .is_words = true});
  return internal::text_table(columns, rows);
}

std::string by_integrator(const char* what, const std::vector<AccuracyRow>& all) {
  std::vector<TextRow> rows;
  for (const AccuracyRow& row : all)
    rows.push_back(row_of({std::string(to_string(row.integrator)), internal::scientific(row.tolerance)}, row));
  return errors_table(what, "tolerance", rows);
}

std::string cloud_table(const AccuracyStudy& study) {
  std::vector<TextRow> rows;
  const auto add = [&](const Figure& f, const Spread& s, bool ill) {
    TextRow& row = rows.emplace_back(TextRow{std::string(f.symbol)});
    if (s.runs == 0) {
      row.emplace_back("none");
      return;
    }
    for (const double value : {s.low, s.median, s.high}) row.push_back(four_digits(value, f.unit));
    row.push_back(fmt::format("{}", s.runs));
    if (ill) row.emplace_back("ill-conditioned");
  };
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    if (study.cloud[i].runs > 0) add(studied_figures[i], study.cloud[i], !study.conditioned[i]);
  }
  add(figure_of(&Metrics::permanent_contact_time), study.permanent_contact_time, false);
  add(figure_of(&Metrics::bounce_count), study.bounce_count, false);
  return internal::text_table({{.head = "cloud", .width = 16, .is_words = true},
                               {.head = "low", .width = 14},
                               {.head = "median", .width = 14},
                               {.head = "high", .width = 14},
                               {.head = "runs", .width = 8},
                               {.is_words = true, .gap = 2}},
                              rows);
}

}  // namespace

json accuracy_json(const PreparedScene& prepared, const AccuracyStudy& study, const Provenance& provenance) {
  json j = with_origin({{"kind", "accuracy"}, {"status", to_string(study.status)}}, prepared, provenance.command);
  if (!study.message.empty()) j["message"] = study.message;
  if (study.rows.empty()) return j;
  j["reference"] = row_json(study.reference);
  j["reference"].erase("relative_errors");
  j["reference"]["resolution"] = errors_json(study.resolution);
  j["rows"] = rows_json(study.rows);
  j["modes"] = rows_json(study.modes);
  j["without_restart_at_contact"] = rows_json(study.through);
  if (!study.why_always_restarted.empty()) j["why_always_restarted"] = study.why_always_restarted;
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    json cloud = spread_json(study.cloud[i]);
    cloud["well_conditioned"] = study.conditioned[i];
    j["cloud"][std::string(studied_figures[i].key)] = std::move(cloud);
  }
  const auto key = [](Figure::Member member) { return std::string(figure_of(member).key); };
  j["cloud"][key(&Metrics::permanent_contact_time)] = spread_json(study.permanent_contact_time);
  j["cloud"][key(&Metrics::bounce_count)] = spread_json(study.bounce_count);
  const std::vector<std::string> words = recommendations(study);
  j["recommendations"] = json::array();
  for (std::size_t i = 0; i < study.recommendations.size(); ++i) {
    const Recommendation& r = study.recommendations[i];
    json one{{"accuracy", r.accuracy}, {"words", words[std::min(i, words.size() - 1)]}, {"setting", nullptr}};
    if (r.row) one["setting"] = row_json(study.rows[*r.row]);
    j["recommendations"].push_back(std::move(one));
  }
  return j;
}

std::string accuracy_text(const AccuracyStudy& study) {
  if (study.rows.empty()) {
    return study.status == Status::no_contact
               ? "The switch does not touch within its window: there are no figures to be accurate in.\n"
               : wrapped(fmt::format("There is no reference to compare with: {}",
                                     study.message.empty() ? std::string(to_string(study.status)) : study.message)) +
                     "\n";
  }
  std::vector<std::string> values;
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    const double value = studied_figures[i].value(study.reference.figures);
    if (std::isfinite(value)) {
      values.push_back(fmt::format("{} {} ({})", studied_figures[i].symbol, four_digits(value, studied_figures[i].unit),
                                   error_cell(study.resolution[i])));
    }
  }
  std::string text = wrapped(fmt::format("Reference: {}, {}: {}. In brackets what a second reference differs by.",
                                         setting_text(study.reference), modes_text(study.reference), fmt::join(values, ", "))) +
                     "\n\n";
  if (!study.message.empty()) text += wrapped("The reference: " + study.message + ".") + "\n\n";
  std::vector<AccuracyRow> of_own_points = study.rows;
  std::erase_if(of_own_points, [&](const AccuracyRow& row) { return row.points_per_length != own_points(study); });
  text += by_integrator("integrator", of_own_points);
  if (!study.through.empty()) text += "\n" + by_integrator("no restart", study.through);
  if (own_points(study)) {
    std::vector<TextRow> rows;
    for (const AccuracyRow* row : quadrature_rows(study))
      rows.push_back(row_of({"", fmt::format("{:g}", *row->points_per_length)}, *row));
    text += "\n" + errors_table("points", "per length", rows);
  }
  if (!study.modes.empty()) {
    std::vector<TextRow> rows;
    for (const AccuracyRow& row : study.modes) rows.push_back(row_of({"", fmt::format("{}", row.modes)}, row));
    text += "\n" + errors_table("modes", "", rows);
  }
  text +=
      "\n" +
      wrapped(fmt::format(
          "Relative errors of the delivered figures against the reference; times are medians of processor time. {} {}",
          own_points(study) ? fmt::format("Integrators with {}, points and modes with {}, tolerance {}. What another number of "
                                          "modes changes is no error of the integration.",
                                          points_text(study.rows.front()), to_string(study.reference.integrator),
                                          internal::scientific(quadrature_rows(study).front()->tolerance))
                            : internal::no_quadrature,
          restart_text(study))) +
      "\n\n";
  text += cloud_table(study) + "\n" +
          wrapped(
              "The cloud: runs whose drives differ by one part in 1e9 to 1e7. Permanent contact time and bounce count are "
              "properties of such a cloud, not of one run.") +
          "\n\n";
  const std::string ill = symbols(study, false);
  if (!ill.empty()) text += wrapped(fmt::format("Ill-conditioned here, and left out of what follows: {}.", ill)) + "\n\n";
  for (const std::string& words : recommendations(study)) text += words + "\n";
  return text;
}

}  // namespace softland
