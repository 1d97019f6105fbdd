// The results of `softland accuracy`: JSON with SI units in the names, a document, and a work-precision diagram.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "document/document.h"
#include "reports/origin.h"
#include "studies/closing/accuracy.h"

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
