#include "reports/accuracy_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "reports/accuracy_words.h"
#include "reports/json_number.h"
#include "reports/origin.h"
#include "reports/result_json.h"

namespace softland {
namespace {

using internal::json_number;
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
  const std::vector<std::string> words = internal::recommendations(study);
  j["recommendations"] = json::array();
  for (std::size_t i = 0; i < study.recommendations.size(); ++i) {
    const Recommendation& r = study.recommendations[i];
    json one{{"accuracy", r.accuracy}, {"words", words[std::min(i, words.size() - 1)]}, {"setting", nullptr}};
    if (r.row) one["setting"] = row_json(study.rows[*r.row]);
    j["recommendations"].push_back(std::move(one));
  }
  return j;
}

}  // namespace softland
