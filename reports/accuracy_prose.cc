#include "reports/accuracy_prose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "document/quantity.h"
#include "reports/closing_captions.h"

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
