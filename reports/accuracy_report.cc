#include "reports/accuracy_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "base/require.h"
#include "document/quantity.h"
#include "reports/closing_captions.h"
#include "reports/study_members.h"

namespace softland::internal {

std::string error_cell(double error) { return std::isinf(error) ? "missing" : relative_error(error); }

std::string four_digits(double value, std::string_view unit) { return quantity(value, unit, 4); }

std::string symbols(const AccuracyStudy& study, bool conditioned) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < studied_figures.size(); ++i) {
    const bool there = std::isfinite(studied_figures[i].value(study.reference.figures));
    if (there && study.conditioned[i] == conditioned) names.push_back(studied_figures[i].symbol);
  }
  if (names.size() < 2) return fmt::format("{}", fmt::join(names, ""));
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

std::string points_text(const AccuracyRow& row) {
  return row.points_per_length ? fmt::format("{:g} points per length", *row.points_per_length) : std::string();
}

std::string setting_text(const AccuracyRow& row) {
  const std::string points = points_text(row);
  return fmt::format("{}, tolerance {}{}{}", to_string(row.integrator), scientific(row.tolerance), points.empty() ? "" : ", ",
                     points);
}

std::string modes_text(const AccuracyRow& row) { return fmt::format("{} mode{}", row.modes, row.modes == 1 ? "" : "s"); }

std::string recommended(const AccuracyStudy& study, const Recommendation& r) {
  if (!r.row) return "no setting that was tried";
  const AccuracyRow& row = study.rows[*r.row];
  return fmt::format("{}: {}", setting_text(row), quantity(row.seconds, "s", 2));
}

std::string restart_text(const AccuracyStudy& study) {
  return study.through.empty() ? fmt::format("There is no run without a restart at the contact: {}.", study.why_always_restarted)
                               : "Without a restart the integrator steps across make and break of contact as across any change "
                                 "of force; simulate restarts it there.";
}

std::vector<std::string> recommendations(const AccuracyStudy& study) {
  std::vector<std::string> lines;
  const std::string figures = symbols(study, true);
  if (figures.empty()) return {"No figure is well-conditioned here: no setting can be recommended."};
  for (const Recommendation& r : study.recommendations) {
    lines.push_back(fmt::format("for {} in {}: {}", scientific(r.accuracy), figures, recommended(study, r)));
  }
  return lines;
}

std::optional<double> own_points(const AccuracyStudy& study) { return study.rows.front().points_per_length; }

std::vector<const AccuracyRow*> quadrature_rows(const AccuracyStudy& study) {
  std::vector<const AccuracyRow*> rows;
  double tightest = std::numeric_limits<double>::infinity();
  for (const AccuracyRow& row : study.rows) {
    const bool tried = row.missing.empty() && row.integrator == study.reference.integrator;
    if (tried && row.points_per_length == own_points(study)) tightest = std::min(tightest, row.tolerance);
  }
  if (std::isinf(tightest)) tightest = study.rows.front().tolerance;
  for (const AccuracyRow& row : study.rows) {
    if (row.integrator == study.reference.integrator && row.tolerance == tightest) rows.push_back(&row);
  }
  std::sort(rows.begin(), rows.end(), [](auto* a, auto* b) { return a->points_per_length < b->points_per_length; });
  return rows;
}

}  // namespace softland::internal

namespace softland {

using nlohmann::json;

namespace internal {
namespace {

void error_members(Archive& a, FigureErrors& errors) {
  constexpr std::string_view about = "relative error of the figure";
  if (a.lists()) return a("FIGURE", errors[0], about);
  for (std::size_t i = 0; i < errors.size(); ++i) a(studied_figures[i].key, errors[i], about);
}

}  // namespace
}  // namespace internal

// The errors of a run are its `errors` in JSON.
void run_members(internal::Archive& a, AccuracyRow& row, std::string_view errors, std::string_view errors_about) {
  a.custom("integrator", row.integrator, internal::integrator_name, internal::read_integrator,
           internal::Like<std::string>{"integrator"});
  a("tolerance", row.tolerance, "relative tolerance");
  a("points_per_length", internal::OrNull{row.points_per_length}, "quadrature points per length of the beam; null for a plate");
  a("modes", row.modes, "number of modes");
  if (a.has(!row.missing.empty())) a("missing", row.missing, "why the run has no figures");
  if (!row.missing.empty()) return;
  a.object(
      errors, [&](auto& inside) { internal::error_members(inside, row.errors); }, errors_about);
  a("metrics", row.figures, "figures of the run");
  a("steps", row.work.steps, "number of steps");
  a("rhs_evaluations", row.work.rhs_evaluations, "number of evaluations of the right-hand side");
  a("cpu_s", row.seconds, "median processor time of one closing");
  a("runs", row.runs, "number of timed runs");
}

void members(internal::Archive& a, AccuracyRow& row) {
  run_members(a, row, "relative_errors", "relative error of each figure against the reference");
}

namespace {

// In JSON, the errors of the reference run are named "resolution": they are the uncertainty of the reference.
json reference_json(const AccuracyStudy& study) {
  json reference = internal::record_json(study.reference);
  reference["resolution"] = reference["relative_errors"];
  internal::Archive resolution = internal::Archive::writer();
  internal::error_members(resolution, const_cast<FigureErrors&>(study.resolution));
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
    r.accuracy = internal::read_json<double>(internal::value_at(one, "accuracy"));
    const auto row = std::ranges::find(rows, internal::value_at(one, "setting"), internal::record_json<AccuracyRow>);
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

namespace internal {

// The JSON of the reference run, whose errors have another name.
struct ReferenceJson {};
void members(Archive& a, ReferenceJson&) {
  AccuracyRow row;
  run_members(a, row, "resolution", "relative difference of each figure from a second reference run");
}

struct RecommendationJson {};
void members(Archive& a, RecommendationJson&) {
  a("accuracy", 0.0, "relative error that is asked for");
  a("words", std::string(), "the recommendation in words");
  a("setting", AccuracyRow{}, "fastest setting within it; null: none");
}

}  // namespace internal

void members(internal::Archive& a, AccuracyRecord& record) {
  AccuracyStudy& study = record.found;
  members(a, record.origin);
  a("status", study.status, "outcome of the reference run");
  if (a.has(!study.message.empty())) a("message", study.message, "why there is no reference run, or why it is looser");
  if (a.has(!study.rows.empty())) a("rows", study.rows, "runs of the integrator of `simulate` and of others");
  if (study.rows.empty()) return;
  a.custom(
      "reference", study.reference, [&](const AccuracyRow&) { return reference_json(study); }, internal::read_json<AccuracyRow>,
      internal::Like<internal::ReferenceJson>{"the reference run"});
  if (a.reads()) {
    internal::Archive reference = internal::Archive::reader(internal::value_at(a.from(), "reference"));
    reference.object(
        "resolution", [&](auto& resolution) { internal::error_members(resolution, study.resolution); },
        "relative difference between two reference runs");
  }
  a("modes", study.modes, "runs with other numbers of modes");
  a("without_restart_at_contact", study.through, "runs without a restart at make and break of contact");
  if (a.has(!study.why_always_restarted.empty()))
    a("why_always_restarted", study.why_always_restarted, "why there are no such runs");
  a.object(
      "cloud",
      [&](auto& cloud) {
        for (std::size_t i = 0; i < (a.lists() ? 1 : studied_figures.size()); ++i) {
          cloud.object(
              a.lists() ? "FIGURE" : studied_figures[i].key,
              [&](auto& one) {
                members(one, study.cloud[i]);
                one("well_conditioned", study.conditioned[i], "whether the error of the figure means something");
              },
              "range of the figure");
        }
        cloud(key_of(&Metrics::permanent_contact_time), study.permanent_contact_time, "range of the permanent contact time");
        cloud(key_of(&Metrics::bounce_count), study.bounce_count, "range of the bounce count");
      },
      "ranges of figures over perturbed runs");
  a.custom(
      "recommendations", study.recommendations, [&](const auto&) { return recommendations_json(study); },
      [&](const json& from) { return read_recommendations(from, study.rows); },
      internal::Like<std::vector<internal::RecommendationJson>>{"fastest setting for each accuracy"});
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
