// The findings of `softland accuracy`: JSON with SI units in the names, a document, and a work-precision diagram.
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

[[nodiscard]] nlohmann::json json_of(const AccuracyRecord& record);
[[nodiscard]] AccuracyRecord read_accuracy(const nlohmann::json& from);
/// Returns recommendations, diagrams, tables, and the ill-conditioned figures over many runs. A study without rows gives the
/// reason why it has none.
[[nodiscard]] Document document_of(const AccuracyRecord& record);
/// Draws error against time, one curve per integrator; the same with and without a restart at the contact; and error against
/// quadrature points, one curve per figure.
[[nodiscard]] std::string svg_of(const AccuracyRecord& record);

}  // namespace softland
