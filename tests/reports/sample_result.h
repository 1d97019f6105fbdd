// Synthetic results in the format of the verbs, with features of real ones: micro-rebounds inside macro-rebounds, a soft
// landing, a search.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

namespace softland::test {

/// Returns the result of a search with both drives. Its plain step touches at 23.186 us and bounces 57 times, up to 803.1 nm,
/// until 374 us; the winner lands at 44.5 us.
[[nodiscard]] nlohmann::json sample_optimize_result(std::size_t rows_per_curve = 12000);
/// Returns the plain step of sample_optimize_result() as the result of `simulate`.
[[nodiscard]] nlohmann::json sample_simulate_result(std::size_t rows_per_curve = 12000);

}  // namespace softland::test
