// How a row of many ended that has no closing's own status: that of a point of an exploration, or of an evaluator.
#pragma once

#include <string_view>

namespace softland {

/// One whose scene cannot be, or cannot be studied: the reason says why.
inline constexpr std::string_view infeasible = "infeasible";
/// One where the program itself went wrong.
inline constexpr std::string_view internal_fault = "internal_error";
/// A search that found nothing better than the plain step.
inline constexpr std::string_view no_success = "no_success";

}  // namespace softland
