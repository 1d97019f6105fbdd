// The results of `softland accuracy`: JSON with SI units in the names, a document, and a work-precision diagram.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/document.h"
#include "reports/origin.h"
#include "studies/closing/accuracy.h"

namespace softland::internal {

// Words and rows that the terminal text and the page share.

/// A sentence that replaces the table of quadratures (integration points along the beam) in the report on a rigid plate.
inline constexpr const char* no_quadrature =
    "A rigid plate has the same gap everywhere: the number of quadrature points does not matter, and none was tried.";

[[nodiscard]] std::string error_cell(double error);
[[nodiscard]] std::string four_digits(double value, std::string_view unit);

/// Returns the symbols of the figures of merit of the reference run that are well-conditioned, or, if `conditioned` is false,
/// of those that are ill-conditioned: "t_i, v_i and B_H".
[[nodiscard]] std::string symbols(const AccuracyStudy& study, bool conditioned);

/// Returns the number of quadrature points along the beam as text: "24 points per length"; empty for a rigid plate.
[[nodiscard]] std::string points_text(const AccuracyRow& row);
[[nodiscard]] std::string setting_text(const AccuracyRow& row);
[[nodiscard]] std::string modes_text(const AccuracyRow& row);
[[nodiscard]] std::string restart_text(const AccuracyStudy& study);
[[nodiscard]] std::string recommended(const AccuracyStudy& study, const Recommendation& recommendation);
/// Returns one recommended setting of the simulation per wanted accuracy, each as a line of text.
[[nodiscard]] std::vector<std::string> recommendations(const AccuracyStudy& study);

/// Returns the number of quadrature points along the length of the beam in the scene; none for a rigid plate.
[[nodiscard]] std::optional<double> own_points(const AccuracyStudy& study);

/// Returns one row of the study per number of quadrature points along the beam: the row of the integrator of `simulate` at the
/// tightest tolerance that was run.
[[nodiscard]] std::vector<const AccuracyRow*> quadrature_rows(const AccuracyStudy& study);

}  // namespace softland::internal

namespace softland {

struct AccuracyRecord {
  Origin origin;
  AccuracyStudy found;
};

/// Names the members of the JSON.
void members(internal::Archive& a, AccuracyRecord& record);
[[nodiscard]] nlohmann::json json_of(const AccuracyRecord& record);
[[nodiscard]] AccuracyRecord read_accuracy(const nlohmann::json& from);
/// Returns a document with recommended settings, work-precision diagrams, tables of errors, and the spread of ill-conditioned
/// figures of merit over many runs. If no setting of the integrator could be compared, the document gives the reason.
[[nodiscard]] Document document_of(const AccuracyRecord& record);
/// Draws three diagrams of errors: against computing time, with a curve per integrator; against computing time, with and
/// without a restart of the integrator at the contact; against quadrature points, with a curve per figure of merit.
[[nodiscard]] std::string svg_of(const AccuracyRecord& record);

}  // namespace softland
