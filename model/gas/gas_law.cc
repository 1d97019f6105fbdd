#include "model/gas/gas_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/engineering.h"
#include "model/built_beam.h"

namespace softland {

double end_flow(double ratio) {
  double sum = 0;
  for (int n = 39; n > 0; n -= 2) sum += std::tanh(n * pi / (2 * ratio)) / std::pow(n, 5);
  return 1 - 192 / std::pow(pi, 5) * ratio * sum;
}

GasLaw gas_law(const Gas& gas, const Structure& s, double unit_quality) {
  return gas_law(gas, s.width, s.thickness, unit_quality);
}

GasLaw gas_law(const Gas& gas, double width, double thickness, double unit_quality) {
  const double length = film_length(gas), kept = std::isnan(length) ? 1 : end_flow(width / length);
  Film film{.width = width, .thickness = thickness, .viscosity = 0, .mean_free_path = 0, .unit_quality = unit_quality};
  if (const FilmState* state = film_of(gas)) {
    film.viscosity = viscosity(*state) * kept;
    film.mean_free_path = mean_free_path(*state);
  }
  return std::visit([&](const auto& own) -> GasLaw { return own.law(film); }, gas);
}

double squeeze_number(const FilmState& gas, double width, double gap, double rate) {
  const VeijolaFilm rarefied{.viscosity = viscosity(gas), .mean_free_path = mean_free_path(gas), .width = 1};
  const double effective_viscosity = -rarefied.load(gap, 1.0) * gap * gap * gap;
  return 12 * effective_viscosity * width * width * rate / (gas.pressure * gap * gap);
}

namespace {

// Returns the gap at which gas laws are evaluated: never less than a hundredth of the rest gap when the beam closes onto a
// dielectric, where the gap vanishes.
double gap_of_film(const Device& device, double gap) {
  return device.closes_on_dielectric() ? std::max(gap, device.gap.electrode / 100) : gap;
}

}  // namespace

double squeeze_number(const Device& device, double rest_gap, const TrajectoryPoint& point) {
  const double h = gap_of_film(device, rest_gap - point.position);
  if (!device.gas || !std::isfinite(limits_of(*device.gas).most_squeeze) || !(h > 0)) return 0;
  return squeeze_number(*film_of(*device.gas), width_at(device.structure, device.contact_position()), h,
                        std::abs(point.velocity) / h);
}

std::vector<std::string> gas_warnings(const Device& device, double smallest_gap, double largest_squeeze) {
  std::vector<std::string> warnings;
  const FilmState* const state = device.gas ? film_of(*device.gas) : nullptr;
  if (state == nullptr) return warnings;
  const FilmLimits limits = limits_of(*device.gas);
  const double lambda = mean_free_path(*state);
  const auto number = [](double value) { return engineering(value, "", 2); };
  const auto warn = [&](const char* what, double value, const char* beyond, double limit, const char* why = "") {
    warnings.push_back(
        fmt::format("gas law {}: {} number {} {} {}{}", name_of(*device.gas), what, number(value), beyond, number(limit), why));
  };
  if (const double kn = lambda / gap_of_film(device, smallest_gap); kn > limits.most_knudsen)
    warn("Knudsen", kn, "exceeds", limits.most_knudsen);
  if (const double kn = lambda / device.gap.electrode; kn < limits.least_knudsen)
    warn("Knudsen", kn, "is below", limits.least_knudsen);
  if (largest_squeeze > limits.most_squeeze)
    warn("squeeze", largest_squeeze, "exceeds", limits.most_squeeze,
         is_compressible(*device.gas) ? ": its boundary layers are too thin to be resolved"
                                      : ": the film is compressed, not squeezed out");
  return warnings;
}

}  // namespace softland
