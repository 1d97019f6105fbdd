// Made-up results in the shape the verbs write, with the features of real ones: micro-rebounds inside macro-rebounds, a soft
// landing, a search.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

namespace softland::test {

/// A combined switch whose plain step touches at 23.186 us and bounces 57 times up to 803.1 nm until 374 us; the winner lands
/// at 44.5 us.
[[nodiscard]] nlohmann::json sample_optimize_result(std::size_t rows_per_curve = 12000);
/// The plain step of the above as the result of `simulate`.
[[nodiscard]] nlohmann::json sample_simulate_result(std::size_t rows_per_curve = 12000);

}  // namespace softland::test
