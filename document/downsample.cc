#include "document/downsample.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace softland::internal {

std::vector<std::size_t> downsampled(const std::vector<const std::vector<double>*>& columns, std::size_t most) {
  const std::size_t rows = columns.empty() ? 0 : columns.front()->size();
  std::vector<std::size_t> kept;
  if (rows <= most) {
    kept.resize(rows);
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  // Each bucket (group of consecutive rows) keeps two rows and the extremes of every column. On smooth curves these are mostly
  // the same rows, so start with as many buckets as rows are permitted, and reduce their number until the rows are few enough.
  for (std::size_t buckets = most;;) {
    kept.clear();
    for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
      const std::size_t begin = bucket * rows / buckets;
      const std::size_t end = (bucket + 1) * rows / buckets;
      if (begin == end) continue;
      kept.push_back(begin);
      kept.push_back(end - 1);
      for (const std::vector<double>* column : columns) {
        std::size_t lowest = end;
        std::size_t highest = end;
        for (std::size_t row = begin; row < end; ++row) {
          const double value = (*column)[row];
          if (!std::isfinite(value)) continue;
          if (lowest == end || value < (*column)[lowest]) lowest = row;
          if (highest == end || value > (*column)[highest]) highest = row;
        }
        if (lowest != end) kept.push_back(lowest);
        if (highest != end) kept.push_back(highest);
      }
    }
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    if (kept.size() <= most) return kept;
    buckets = std::max<std::size_t>(1, std::min(buckets - 1, buckets * most / kept.size()));
  }
}

}  // namespace softland::internal
