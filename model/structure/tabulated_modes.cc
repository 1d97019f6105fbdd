#include "model/structure/tabulated_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/engineering.h"
#include "base/require.h"
#include "base/straight_lines.h"
#include "model/constants.h"
#include "model/structure/structure.h"

namespace softland {
namespace {

// Throws InvalidInput with the text `rule`, a rule about tables of modes, unless `holds` is true.
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

ModalTable::ModalTable(std::vector<double> positions, std::vector<double> frequencies, std::vector<std::vector<double>> shapes,
                       std::vector<double> rest_offsets, std::vector<double> widths, SplineEnd far_end)
    : positions_(std::move(positions)),
      frequencies_(std::move(frequencies)),
      shapes_(std::move(shapes)),
      rest_offsets_(std::move(rest_offsets)),
      widths_(std::move(widths)),
      far_end_(far_end) {
  constexpr std::size_t fewest = 3;
  require_table(positions_.size() >= fewest && positions_.front() == 0 && rises(positions_) && is_finite(positions_),
                "there must be at least three positions that increase from 0, the clamp");
  require_table(!frequencies_.empty() && frequencies_.front() > 0 && rises(frequencies_) && is_finite(frequencies_),
                "the frequencies must be positive and increase");
  require_table(shapes_.size() == frequencies_.size(), "there must be as many shapes as frequencies");
  require_table(rest_offsets_.empty() || (rest_offsets_.size() == positions_.size() && is_finite(rest_offsets_)),
                "there must be one finite rest offset per position, or none");
  const auto is_width = [](double width) { return width > 0 && width < 1e30; };
  require_table(widths_.empty() || (widths_.size() == positions_.size() && std::ranges::all_of(widths_, is_width)),
                "there must be one width above 0 per position, or none");
  for (const std::vector<double>& shape : shapes_) {
    require_table(shape.size() == positions_.size(), "a shape must have a value per position");
    require_table(is_finite(shape) && shape.front() == 0, "a shape must be finite and 0 at the clamp");
    require_table(std::any_of(shape.begin(), shape.end(), [](double v) { return v != 0; }), "a shape must not be 0 everywhere");
    splines_.emplace_back(positions_, shape, far_end);
  }
  if (!has_far_clamp()) return;
  require_table(is_held_at_both_ends(), "a clamped far end must not move in any mode");
  require_table(!is_hinged_at_end(positions_, shapes_.front()), "the first mode must leave a clamped far end without a slope");
}

double ModalTable::rest_offset(double x) const {
  return rest_offsets_.empty() ? 0 : rest_offsets_.front() - along_lines(positions_, rest_offsets_, x);
}

double ModalTable::lowest_rest_offset() const {
  return rest_offsets_.empty() ? 0 : rest_offsets_.front() - std::ranges::max(rest_offsets_);
}

bool ModalTable::is_held_at_both_ends() const {
  constexpr double still = 1e-4;  // smaller motion of the far end counts as 0; share of the mode's largest motion
  return std::all_of(shapes_.begin(), shapes_.end(), [](const std::vector<double>& shape) {
    const auto [low, high] = std::minmax_element(shape.begin(), shape.end());
    return std::abs(shape.back()) <= still * std::max(-*low, *high);
  });
}

std::vector<double> ModalTable::slope_products(int modes) const {
  std::vector<double> products;
  for (int j = 0; j < modes; ++j) {
    for (int i = 0; i < modes; ++i)
      products.push_back(splines_[static_cast<std::size_t>(i)].integral_of_slopes(splines_[static_cast<std::size_t>(j)]));
  }
  return products;
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

int ModalStructure::most_modes() const { return table ? std::min(Structure::most_modes, table->count()) : Structure::most_modes; }

std::string ModalStructure::why_invalid(double length, int modes) const {
  if (table == nullptr) return "structure.kind = modes: there is no table of modes";
  if (length != table->length()) {
    return fmt::format("structure.length = {}: must be the length of the table of modes, {}", engineering(length, "m"),
                       engineering(table->length(), "m"));
  }
  if (table->is_held_at_both_ends() && !table->has_far_clamp())
    return "structure.kind = modes: the far end stands still in every mode: far_anchor = \"clamped\" says that it is held";
  if (!std::isnan(axial_stiffness)) {
    if (!table->has_far_clamp())
      return "structure.axial_stiffness: needs far_anchor = \"clamped\": a structure stretches between two clamps only";
    if (!table->rest_offsets().empty())
      return "structure.axial_stiffness: cannot stand beside rest offsets: a curved structure stretches between two clamps as an "
             "arch, which is not simulated";
  }
  if (modes > table->count())
    return fmt::format("structure.modes = {}: must not exceed {}, the modes of the file", modes, table->count());
  return {};
}

std::shared_ptr<const ModalTable> ModalStructure::example_table() {
  static const auto table = [] {
    constexpr int places = 40;
    constexpr double length = 250e-6, mass = 19300 * 20e-6 * 2e-6 * length;
    // The modes of a gold cantilever: roots of cos x cosh x = -1, from which the shapes follow, and frequencies [Hz].
    constexpr std::array roots{1.87510406871, 4.69409113297}, frequencies{10394.0, 65139.0};
    std::vector<double> x;
    std::vector<std::vector<double>> shapes(roots.size());
    for (int i = 0; i <= places; ++i) {
      x.push_back(length * i / places);
      for (std::size_t k = 0; k < roots.size(); ++k) {
        const double b = roots[k], z = b * i / places, sigma = (std::cosh(b) + std::cos(b)) / (std::sinh(b) + std::sin(b));
        shapes[k].push_back(((std::cosh(z) - std::cos(z)) - sigma * (std::sinh(z) - std::sin(z))) / std::sqrt(mass));
      }
    }
    return std::make_shared<const ModalTable>(x, std::vector<double>(frequencies.begin(), frequencies.end()), shapes);
  }();
  return table;
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
