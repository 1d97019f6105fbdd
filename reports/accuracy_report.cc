#include "reports/accuracy_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/require.h"
#include "reports/accuracy_prose.h"
#include "reports/study_members.h"

namespace softland {

using nlohmann::json;

namespace internal {
namespace {

template <class A>
void members(A& a, FigureErrors& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) a(studied_figures[i].key, errors[i]);
}

}  // namespace
}  // namespace internal

template <class A>
void members(A& a, AccuracyRow& row) {
  a.custom("integrator", row.integrator, internal::integrator_name, internal::read_integrator);
  a("tolerance", row.tolerance);
  a("points_per_length", internal::OrNull{row.points_per_length});
  a("modes", row.modes);
  if (a.has(!row.missing.empty())) a("missing", row.missing);
  if (!row.missing.empty()) return;
  a.object("relative_errors", [&](auto& errors) { internal::members(errors, row.errors); });
  a("metrics", row.figures);
  a("steps", row.work.steps);
  a("rhs_evaluations", row.work.rhs_evaluations);
  a("cpu_s", row.seconds);
  a("runs", row.runs);
}

namespace {

// In JSON, the errors of the reference run are named "resolution": they are the uncertainty of the reference.
json reference_json(const AccuracyStudy& study) {
  json reference = internal::record_json(study.reference);
  reference["resolution"] = reference["relative_errors"];
  internal::JsonWriter resolution;
  internal::members(resolution, const_cast<FigureErrors&>(study.resolution));
  reference["resolution"] = std::move(resolution).take();
  reference.erase("relative_errors");
  return reference;
}

json recommendations_json(const AccuracyStudy& study) {
  json all = json::array();
  const std::vector<std::string> words = internal::recommendations(study);
  for (std::size_t i = 0; i < study.recommendations.size(); ++i) {
    const Recommendation& r = study.recommendations[i];
    all.push_back({{"accuracy", r.accuracy},
                   {"words", words[std::min(i, words.size() - 1)]},
                   {"setting", r.row ? internal::record_json(study.rows[*r.row]) : json()}});
  }
  return all;
}

std::vector<Recommendation> read_recommendations(const json& from, const std::vector<AccuracyRow>& rows) {
  std::vector<Recommendation> all;
  for (const json& one : from.is_array() ? from : json::array()) {
    Recommendation& r = all.emplace_back();
    const internal::JsonReader members(one);
    r.accuracy = internal::JsonReader::read<double>(members.at("accuracy"));
    const auto row = std::ranges::find(rows, members.at("setting"), internal::record_json<AccuracyRow>);
    if (row != rows.end()) r.row = static_cast<std::size_t>(row - rows.begin());
  }
  return all;
}

// Sets the error of a figure of merit to infinity if the reference run has the figure and the row's run lacks the figure; the
// row was read from JSON, which cannot express infinity.
void set_missing(std::vector<AccuracyRow>& rows, const Metrics& reference) {
  for (AccuracyRow& row : rows) {
    for (std::size_t i = 0; i < row.errors.size(); ++i) {
      if (std::isnan(row.errors[i]) && std::isfinite(studied_figures[i].value(reference)))
        row.errors[i] = std::numeric_limits<double>::infinity();
    }
  }
}

}  // namespace

template <class A>
void members(A& a, AccuracyRecord& record) {
  AccuracyStudy& study = record.found;
  members(a, record.origin);
  a("status", study.status);
  if (a.has(!study.message.empty())) a("message", study.message);
  if (a.has(!study.rows.empty())) a("rows", study.rows);
  if (study.rows.empty()) return;
  a.custom(
      "reference", study.reference, [&](const AccuracyRow&) { return reference_json(study); },
      internal::JsonReader::read<AccuracyRow>);
  if constexpr (A::reads) {
    internal::JsonReader reference(a.at("reference"));
    reference.object("resolution", [&](auto& resolution) { internal::members(resolution, study.resolution); });
  }
  a("modes", study.modes);
  a("without_restart_at_contact", study.through);
  if (a.has(!study.why_always_restarted.empty())) a("why_always_restarted", study.why_always_restarted);
  a.object("cloud", [&](auto& cloud) {
    for (std::size_t i = 0; i < studied_figures.size(); ++i) {
      cloud.object(studied_figures[i].key, [&](auto& one) {
        members(one, study.cloud[i]);
        one("well_conditioned", study.conditioned[i]);
      });
    }
    cloud(key_of(&Metrics::permanent_contact_time), study.permanent_contact_time);
    cloud(key_of(&Metrics::bounce_count), study.bounce_count);
  });
  a.custom(
      "recommendations", study.recommendations, [&](const auto&) { return recommendations_json(study); },
      [&](const json& from) { return read_recommendations(from, study.rows); });
}

json json_of(const AccuracyRecord& record) { return internal::record_json(record); }

AccuracyRecord read_accuracy(const json& from) {
  AccuracyRecord record = internal::whole_record<AccuracyRecord>(from);
  AccuracyStudy& study = record.found;
  if (study.rows.empty()) return record;
  const auto has_points = [](const AccuracyRow& row) { return row.points_per_length.has_value(); };
  require(std::ranges::all_of(study.rows, [&](const AccuracyRow& row) { return has_points(row) == has_points(study.rows[0]); }) &&
              !internal::quadrature_rows(study).empty(),
          "\"rows\" are not those of one study");
  for (std::vector<AccuracyRow>* rows : {&study.rows, &study.modes, &study.through}) set_missing(*rows, study.reference.figures);
  return record;
}

}  // namespace softland
