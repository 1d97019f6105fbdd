// Charts as JSON for the script of a web page; the values of curves become small whole numbers.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "document/chart.h"

namespace softland::internal {

/// Returns the values of a column as JSON in small whole numbers, {"unit": u, "steps": [...]}: value k is u times the sum of
/// steps 0 ... k. A null among the steps means that value k is missing; the sum skips it.
[[nodiscard]] nlohmann::json packed(const std::vector<double>& column, double unit);
/// Returns curve tables and charts for the page's script. Columns are thinned to at most `rows` rows per table and stored as
/// integer steps of a unit: one part in ten million of the largest value, which no reader can see. Columns of logarithmic
/// charts are stored as numbers.
[[nodiscard]] nlohmann::json chart_json(const Picture& picture, std::size_t rows);

}  // namespace softland::internal
