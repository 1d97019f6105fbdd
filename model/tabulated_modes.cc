#include "model/tabulated_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/require.h"
#include "model/constants.h"

namespace softland {
namespace {

// A stretch of text in messages about a table.
void require_table(bool holds, const char* rule) {
  require(holds, [&] { return fmt::format("modes of a table: {}", rule); });
}

bool rises(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) { return !(a < b); }) == values.end();
}

bool is_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::abs(v) < 1e30; });
}

}  // namespace

ModalTable::ModalTable(std::vector<double> positions, std::vector<double> frequencies, std::vector<std::vector<double>> shapes)
    : positions_(std::move(positions)), frequencies_(std::move(frequencies)), shapes_(std::move(shapes)) {
  constexpr std::size_t fewest = 3;
  require_table(positions_.size() >= fewest && positions_.front() == 0 && rises(positions_) && is_finite(positions_),
                "three positions at least must rise from 0, the clamp");
  require_table(!frequencies_.empty() && frequencies_.front() > 0 && rises(frequencies_) && is_finite(frequencies_),
                "the frequencies must be positive and rise");
  require_table(shapes_.size() == frequencies_.size(), "there must be as many shapes as frequencies");
  for (const std::vector<double>& shape : shapes_) {
    require_table(shape.size() == positions_.size(), "a shape must have a value per position");
    require_table(is_finite(shape) && shape.front() == 0, "a shape must be 0 at the clamp, and finite");
    require_table(std::any_of(shape.begin(), shape.end(), [](double v) { return v != 0; }), "a shape must move");
    splines_.emplace_back(positions_, shape);
  }
}

bool ModalTable::is_held_at_both_ends() const {
  constexpr double still = 1e-4;  // of the largest motion
  return std::all_of(shapes_.begin(), shapes_.end(), [](const std::vector<double>& shape) {
    const auto [low, high] = std::minmax_element(shape.begin(), shape.end());
    return std::abs(shape.back()) <= still * std::max(-*low, *high);
  });
}

Eigen::VectorXd TabulatedModes::Shapes::value(double x) const {
  Eigen::VectorXd values(modes);
  for (int i = 0; i < modes; ++i) values[i] = table->value(i, x * table->length());
  return values;
}

Eigen::VectorXd TabulatedModes::Shapes::slope(double x) const {
  Eigen::VectorXd slopes(modes);
  for (int i = 0; i < modes; ++i) slopes[i] = table->slope(i, x * table->length()) * table->length();
  return slopes;
}

double TabulatedModes::Shapes::pinned_inverse_square(double x, std::optional<double> /*near*/) const {
  if (table->count() == 1) return 1;
  constexpr int halvings = 200;
  const std::vector<double>& f = table->frequencies();
  double low = 1, high = std::pow(f[1] / f[0], 2);
  for (int k = 0; k < halvings; ++k) {
    const double middle = (low + high) / 2;
    double sum = 0;
    for (int i = 0; i < table->count(); ++i) {
      const double here = table->value(i, x * table->length());
      sum += here * here / (std::pow(f[static_cast<std::size_t>(i)] / f[0], 2) - middle);
    }
    (sum > 0 ? high : low) = middle;
  }
  return 1 / low;
}

TabulatedModes::TabulatedModes(std::shared_ptr<const ModalTable> table, int modes, double frequency_factor) {
  require(table != nullptr, "structure.file: the modes of a structure of kind \"modes\" are missing");
  require(modes >= 1 && modes <= table->count(), [&] {
    return fmt::format("structure.modes = {}: must be from 1 to {}, the modes of the file", modes, table->count());
  });
  frequencies_.resize(modes);
  for (int i = 0; i < modes; ++i) frequencies_[i] = frequency_factor * 2 * pi * table->frequencies()[static_cast<std::size_t>(i)];
  shapes_ = {.table = std::move(table), .modes = modes};
}

}  // namespace softland
