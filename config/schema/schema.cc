#include "config/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

#include "base/engineering.h"
#include "base/nearest.h"
#include "config/schema/sections.h"

namespace softland::internal {
namespace {

/// Permitted range of values of one dimension in a scene [SI unit]. Values of real switches lie far inside, and products of a
/// few values in the range stay within double precision.
struct Extent {
  Dimension dimension;
  double smallest;  ///< smallest permitted value of a positive quantity
  double largest;   ///< largest permitted absolute value of a quantity
};
constexpr std::array extents{
    Extent{dimension::none, 1e-12, 1e12},
    Extent{dimension::length, 1e-12, 1},
    Extent{dimension::mass, 1e-30, 1e3},
    Extent{dimension::time, 1e-15, 1e3},
    Extent{dimension::temperature, 1e-3, 1e5},
    Extent{dimension::angle, 1e-12, 1e6},
    Extent{dimension::static_pull_in, 1e-12, 1e3},
    Extent{dimension::dynamic_pull_in, 1e-12, 1e3},
    Extent{dimension::area, 1e-24, 1},
    Extent{dimension::area_density, 1, 1e24},
    Extent{dimension::density, 1e-6, 1e6},
    Extent{dimension::frequency, 1e-6, 1e15},
    Extent{dimension::angular_frequency, 1e-6, 1e15},
    Extent{dimension::force, 1e-18, 1},
    Extent{dimension::energy, 1e-30, 1},
    Extent{dimension::pressure, 1e-12, 1e15},
    Extent{dimension::stress_gradient, 1e-6, 1e18},
    Extent{dimension::viscosity, 1e-18, 1e6},
    Extent{dimension::stiffness, 1e-12, 1e12},
    Extent{dimension::rotational_stiffness, 1e-24, 1e6},
    Extent{dimension::resistance, 1e-6, 1e15},
    Extent{dimension::resistivity, 1e-12, 1e6},
    Extent{dimension::capacitance, 1e-18, 1},
    Extent{dimension::slowness, 1e-12, 1e5},
    Extent{dimension::voltage, 1e-12, 1e9},
    Extent{dimension::slew_rate, 1e-6, 1e24},
    Extent{dimension::piezo_coefficient, 1e-18, 1e-6},
    Extent{dimension::charge_density, 1e-12, 1e6},
    Extent{dimension::damping, 1e-18, 1e6},
};

}  // namespace

Range Key::range_of(const Dimension& dimension) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto found =
      std::find_if(extents.begin(), extents.end(), [&](const Extent& extent) { return extent.dimension == dimension; });
  if (type == KeyType::integer || found == extents.end()) return range;
  Range closed = range;
  if (closed.most == infinity) closed.most = found->largest;
  if (closed.least == -infinity) closed.least = -found->largest;
  if (closed.least == 0 && closed.least_open) {
    closed.least = found->smallest;
    closed.least_open = false;
  }
  return closed;
}

std::string Key::example_of(const Dimension& dimension) const {
  if (dimension == dimensions.front()) {
    if (!like.empty()) return std::string(like);
    // The default of a key serves as its example if the default is a quantity other than 0.
    if (type == KeyType::quantity && fallback.starts_with('\'') && !fallback.starts_with("'0 "))
      return std::string(fallback.substr(1, fallback.size() - 2));
  }
  return std::string(example(dimension));
}

bool Key::is_bare_number() const {
  const bool is_quantity = type == KeyType::quantity || type == KeyType::quantities;
  return is_quantity && dimensions.size() == 1 && dimensions.front() == dimension::none;
}

bool Key::belongs_to(std::string_view choice) const {
  return only_for.empty() || std::find(only_for.begin(), only_for.end(), choice) != only_for.end();
}

const Key* Section::find(std::string_view key, std::string_view choice) const {
  const Key* found = nullptr;
  for (const Key& candidate : keys) {
    if (candidate.name != key) continue;
    if (candidate.belongs_to(choice)) return &candidate;
    if (!found) found = &candidate;
  }
  return found;
}

const std::vector<Section>& schema() {
  static const std::vector<Section> sections{
      title_section(),        structure_section(),  gap_section(),      electrode_section(), gas_section(),
      contact_section(),      dispersion_section(), surface_section(),  piezo_section(),     waveform_section(),
      force_factor_section(), driver_section(),     simulate_section(), load_section(),      metrics_section(),
      spread_section(),       calibration_section()};
  return sections;
}

const Section* find_section(std::string_view name, std::string_view entry) {
  const Section* found = nullptr;
  for (const Section& section : schema()) {
    if (section.name == name && (section.entry.empty() || section.entry == entry)) found = &section;
  }
  return found;
}

const Key* find_key(const std::vector<std::string>& path) {
  const Section* section = find_section(path.front(), path.size() > 1 ? path[1] : std::string());
  const Key* key = section != nullptr ? section->find(path.back()) : nullptr;
  for (std::size_t i = 1; section != nullptr && i + 1 < path.size(); ++i) {
    const Key* const table = section->find(std::string_view(path[i]).substr(0, path[i].find('[')));
    if (table == nullptr || table->part == nullptr) continue;
    section = table->part();
    key = section->find(path.back());
  }
  return key;
}

std::string hint(std::string_view word, const std::vector<std::string_view>& known) {
  const std::string near = did_you_mean(word, known);
  return !near.empty() || known.empty() ? near : fmt::format(" (known: {})", fmt::join(known, ", "));
}

}  // namespace softland::internal
