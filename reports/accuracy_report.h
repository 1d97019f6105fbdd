// What `softland accuracy` found: JSON with SI units in the names, a document, and a work-precision diagram.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/document.h"
#include "reports/result_maker.h"
#include "studies/closing/accuracy.h"

namespace softland {

[[nodiscard]] nlohmann::json accuracy_json(const PreparedScene& prepared, const AccuracyStudy& study,
                                           const Provenance& provenance);
/// Recommendations, diagrams, tables, clouds; of a study without rows why it has none.
[[nodiscard]] Document accuracy_document(const PreparedScene& prepared, const AccuracyStudy& study, const Provenance& provenance);
/// Error against time, one curve per integrator; the same with and without a restart at the contact; and error against quadrature
/// points, one curve per figure.
[[nodiscard]] std::string accuracy_svg(const std::string& title, const AccuracyStudy& study);

}  // namespace softland
