// What `softland accuracy` found: JSON with SI units in the names, tables for a terminal, a work-precision diagram, and a page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/result_maker.h"
#include "studies/closing/accuracy.h"

namespace softland {

[[nodiscard]] nlohmann::json accuracy_json(const PreparedScene& prepared, const AccuracyStudy& study,
                                           const Provenance& provenance);
[[nodiscard]] std::string accuracy_text(const AccuracyStudy& study);
/// A self-contained page (html.h) of a study that has rows: recommendations, diagrams, tables, clouds.
[[nodiscard]] std::string accuracy_html(const PreparedScene& prepared, const AccuracyStudy& study, const Provenance& provenance);
/// Error against time, one curve per integrator; the same with and without a restart at the contact; and error against quadrature
/// points, one curve per figure.
[[nodiscard]] std::string accuracy_svg(const std::string& title, const AccuracyStudy& study);

}  // namespace softland
