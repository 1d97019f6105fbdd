// Fewer points, same picture.
#pragma once

#include <cstddef>
#include <vector>

namespace softland::internal {

/// Rows to keep so that at most `most` remain and every column keeps its extremes: consecutive rows are put into buckets, and of
/// each bucket the first and last row stay and, per column, the rows of its smallest and largest value. Increasing row numbers;
/// all of them when they are few enough. Non-finite values never count as extremes. Columns have equal length; `most` is at least
/// 2 * columns + 2.
[[nodiscard]] std::vector<std::size_t> downsampled(const std::vector<const std::vector<double>*>& columns, std::size_t most);

}  // namespace softland::internal
