// Words and rows that the text and the page of `softland accuracy` share.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/closing/accuracy.h"

namespace softland::internal {

/// What a plate's report says in the place of its table of quadratures.
inline constexpr const char* no_quadrature =
    "A rigid plate has the same gap everywhere: the number of quadrature points does not matter, and none were tried.";

[[nodiscard]] std::string error_cell(double error);
[[nodiscard]] std::string four_digits(double value, std::string_view unit);

/// "t_i, v_i and B_H": the figures of the reference that are well-conditioned, or those that are not.
[[nodiscard]] std::string symbols(const AccuracyStudy& study, bool conditioned);

/// "24 points per length"; empty for a plate.
[[nodiscard]] std::string points_text(const AccuracyRow& row);
[[nodiscard]] std::string setting_text(const AccuracyRow& row);
[[nodiscard]] std::string modes_text(const AccuracyRow& row);
[[nodiscard]] std::string restart_text(const AccuracyStudy& study);
[[nodiscard]] std::string recommended(const AccuracyStudy& study, const Recommendation& recommendation);
/// One line per wanted accuracy.
[[nodiscard]] std::vector<std::string> recommendations(const AccuracyStudy& study);

/// Quadrature points per length of the scene; none for a plate.
[[nodiscard]] std::optional<double> own_points(const AccuracyStudy& study);

/// The rows with the integrator that simulate takes at the tightest tolerance that ran, one per number of points.
[[nodiscard]] std::vector<const AccuracyRow*> quadrature_rows(const AccuracyStudy& study);

}  // namespace softland::internal
