// Statuses of a row of an exploration or of an evaluator, for rows that have no status of a closing.
#pragma once

#include <string_view>

namespace softland {

/// Status of a row whose scene is impossible or cannot be studied; the row has the reason.
inline constexpr std::string_view infeasible = "infeasible";
/// Status of a row that ended with an error of the program itself.
inline constexpr std::string_view internal_fault = "internal_error";
/// Status of a row whose search found nothing better than the plain step.
inline constexpr std::string_view no_success = "no_success";

}  // namespace softland
