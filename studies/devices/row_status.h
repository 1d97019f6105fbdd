// Statuses of a row of an exploration or of an evaluator that has no status of a closing.
#pragma once

#include <string_view>

namespace softland {

/// The scene of the row is impossible or cannot be studied; the row has the reason.
inline constexpr std::string_view infeasible = "infeasible";
/// An error of the program itself.
inline constexpr std::string_view internal_fault = "internal_error";
/// The search found nothing better than the plain step.
inline constexpr std::string_view no_success = "no_success";

}  // namespace softland
