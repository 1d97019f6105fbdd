#include "sampling/sobol_indices.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/require.h"

namespace softland {
namespace {

// Contribution of each row of the design to the sums that estimate Sobol' indices. f is the figure of merit less its mean, A
// and B are the two points of the row (sobol_indices.h).
struct Rows {
  std::size_t dimensions, count;
  std::vector<double> sums, squares;  // f(A) + f(B) and f(A)^2 + f(B)^2 of each row, for its points A and B
  // Terms of the sums for the first-order and the total index, before the division by the variance. Element j d + i belongs to
  // row j and variable i of d variables.
  std::vector<double> first_order, total;
};

Rows rows_of(std::size_t dimensions, const std::vector<double>& kept, double mean) {
  const std::size_t width = dimensions + 2;
  Rows rows{.dimensions = dimensions, .count = kept.size() / width};
  for (std::size_t j = 0; j < rows.count; ++j) {
    const double* const f = &kept[j * width];
    const double a = f[0] - mean, b = f[1] - mean;
    rows.sums.push_back(a + b);
    rows.squares.push_back(a * a + b * b);
    for (std::size_t i = 0; i < dimensions; ++i) {
      rows.first_order.push_back(b * (f[2 + i] - f[0]));
      rows.total.push_back((f[2 + i] - f[0]) * (f[2 + i] - f[0]) / 2);
    }
  }
  return rows;
}

struct Estimate {
  double variance = 0;
  std::vector<double> first_order, total;
};

// Estimates Sobol' indices from rows.count rows of the design, with the indices row_at(0), row_at(1), ...: every row once, or
// the rows that a bootstrap repetition draws with replacement.
template <class RowAt>
Estimate estimate(const Rows& rows, RowAt row_at) {
  const std::size_t d = rows.dimensions;
  Estimate made{.first_order = std::vector<double>(d, 0), .total = std::vector<double>(d, 0)};
  double sum = 0, squares = 0;
  for (std::size_t k = 0; k < rows.count; ++k) {
    const std::size_t j = row_at(k);
    sum += rows.sums[j];
    squares += rows.squares[j];
    for (std::size_t i = 0; i < d; ++i) {
      made.first_order[i] += rows.first_order[j * d + i];
      made.total[i] += rows.total[j * d + i];
    }
  }
  const double n = static_cast<double>(rows.count), mean = sum / (2 * n);
  made.variance = squares / (2 * n) - mean * mean;  // no cancellation, because the figures are centred
  for (std::size_t i = 0; i < d; ++i) {
    made.first_order[i] /= n * made.variance;
    made.total[i] /= n * made.variance;
  }
  return made;
}

SobolIndex index_of(double value, const std::vector<double>& repetitions, double confidence) {
  const Interval interval = internal::percentile_interval(repetitions, confidence);
  return {.value = value, .interval = interval, .above_zero = value > 0 && interval.low > 0};
}

SobolIndices indices_of(std::size_t dimensions, const std::vector<double>& kept, const BootstrapOptions& options) {
  const std::size_t width = dimensions + 2;
  double sum = 0;
  for (std::size_t j = 0; j < kept.size(); j += width) sum += kept[j] + kept[j + 1];
  const double mean = sum * static_cast<double>(width) / (2 * static_cast<double>(kept.size()));
  SobolIndices made{.mean = mean, .variance = 0};
  made.first_order.resize(dimensions);
  made.total.resize(dimensions);
  const Rows rows = rows_of(dimensions, kept, mean);
  const Estimate whole = estimate(rows, [](std::size_t k) { return k; });
  if (!(whole.variance > 0)) return made;
  made.variance = whole.variance;
  std::vector<std::vector<double>> first_order(dimensions), total(dimensions);
  for (std::size_t repetition = 0; repetition < static_cast<std::size_t>(options.repetitions); ++repetition) {
    const Estimate drawn =
        estimate(rows, [&](std::size_t k) { return internal::bootstrap_row(options.seed, repetition, k, rows.count); });
    for (std::size_t i = 0; i < dimensions; ++i) {
      first_order[i].push_back(drawn.first_order[i]);
      total[i].push_back(drawn.total[i]);
    }
  }
  for (std::size_t i = 0; i < dimensions; ++i) {
    made.first_order[i] = index_of(whole.first_order[i], first_order[i], options.confidence);
    made.total[i] = index_of(whole.total[i], total[i], options.confidence);
  }
  return made;
}

}  // namespace

SobolDesign::SobolDesign(PointSet kind, std::size_t dimensions, std::uint64_t seed, std::uint64_t rows)
    : points_(kind, 2 * dimensions, seed, Stream::indices, rows) {}

void SobolDesign::point(std::uint64_t m, std::span<double> u) const {
  require(m < evaluations(), "the number of an evaluation must be below the number of evaluations of the design");
  require(u.size() == dimensions(), "a point must have one coordinate per dimension of the design");
  const std::size_t d = dimensions(), column = m % (d + 2);
  std::vector<double> both(2 * d);
  points_.point(m / (d + 2), both);
  const auto b = both.begin() + static_cast<std::ptrdiff_t>(d);
  std::copy_n(column == 1 ? b : both.begin(), d, u.begin());
  if (column >= 2) u[column - 2] = both[d + column - 2];
}

SobolEstimate sobol_indices(std::size_t dimensions, std::span<const double> figures, const SobolOptions& options) {
  internal::check(options.bootstrap);
  const std::size_t width = dimensions + 2;
  require(dimensions >= 1 && !figures.empty() && figures.size() % width == 0,
          std::to_string(figures.size()) + " figures are given; their number must be a positive multiple of " +
              std::to_string(width));
  SobolEstimate made{.rows = figures.size() / width};
  std::vector<double> kept;
  for (std::size_t j = 0; j < made.rows; ++j) {
    const auto row = figures.subspan(j * width, width);
    if (std::all_of(row.begin(), row.end(), [](double f) { return std::isfinite(f); })) {
      kept.insert(kept.end(), row.begin(), row.end());
    } else {
      ++made.failed_rows;
    }
  }
  const bool too_many = static_cast<double>(made.failed_rows) > options.most_failed * static_cast<double>(made.rows);
  if (!too_many && kept.size() >= 2 * width) made.indices = indices_of(dimensions, kept, options.bootstrap);
  return made;
}

}  // namespace softland
