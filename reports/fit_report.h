// What a fit found: JSON with SI units, and a document.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/document.h"
#include "reports/result_maker.h"
#include "studies/fitting/fit.h"

namespace softland {

[[nodiscard]] nlohmann::json fit_json(const Fit& fit, const Provenance& provenance);
/// Values and their intervals, what the data cannot tell apart and what would, residuals.
[[nodiscard]] Document fit_document(const Fit& fit, const Provenance& provenance);
/// What is said in words: the residuals as a whole, data that do not agree, what the data cannot tell apart, minima.
[[nodiscard]] std::vector<std::string> fit_words(const Fit& fit);

}  // namespace softland
