// The status of a row without a closing's own status: of a point of an exploration, or of an evaluator.
#pragma once

#include <string_view>

namespace softland {

/// The scene is impossible, or cannot be studied: the reason says why.
inline constexpr std::string_view infeasible = "infeasible";
/// The program itself failed.
inline constexpr std::string_view internal_fault = "internal_error";
/// A search found nothing better than the plain step.
inline constexpr std::string_view no_success = "no_success";

}  // namespace softland
