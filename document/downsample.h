// Downsampling keeps fewer points of a curve such that its picture stays the same.
#pragma once

#include <cstddef>
#include <vector>

namespace softland::internal {

/// Returns the numbers of at most `most` rows to keep, in increasing order, such that every column keeps its extremes. Each
/// group of consecutive rows keeps its first and last row and, per column, the rows of its smallest and largest finite value.
/// All rows are kept if they are few enough. Columns have equal length; `most` is at least 2 * columns + 2.
[[nodiscard]] std::vector<std::size_t> downsampled(const std::vector<const std::vector<double>*>& columns, std::size_t most);

}  // namespace softland::internal
