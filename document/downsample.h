// Downsampling keeps fewer points for the same picture.
#pragma once

#include <cstddef>
#include <vector>

namespace softland::internal {

/// Returns rows to keep so that at most `most` remain and every column keeps its extremes. Consecutive rows go into buckets.
/// Each bucket keeps its first and last row and, per column, the rows of its smallest and largest value. Row numbers increase;
/// all rows stay when they are few enough. Non-finite values never count as extremes. Columns have equal length; `most` is at
/// least 2 * columns + 2.
[[nodiscard]] std::vector<std::size_t> downsampled(const std::vector<const std::vector<double>*>& columns, std::size_t most);

}  // namespace softland::internal
