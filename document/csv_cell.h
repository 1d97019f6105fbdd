// A cell of a CSV file (RFC 4180).
#pragma once

#include <string>

namespace softland::internal {

/// Returns the shortest text that reads back to the same bits; empty for a number that is missing (not finite).
[[nodiscard]] std::string csv_cell(double value);
/// Quotes a text that a reader of CSV would otherwise split or change.
[[nodiscard]] std::string csv_cell(const std::string& text);

}  // namespace softland::internal
