#include "model/gas/gas_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/engineering.h"

namespace softland {
namespace {

struct GasNumber {
  std::string_view key;
  double Gas::*member;
};
constexpr std::array keys_of_some_laws{
    GasNumber{"viscosity", &Gas::viscosity},     GasNumber{"pressure", &Gas::pressure},
    GasNumber{"temperature", &Gas::temperature}, GasNumber{"mean_free_path", &Gas::mean_free_path},
    GasNumber{"film_length", &Gas::film_length}, GasNumber{"slit_height", &Gas::slit_height},
    GasNumber{"slit_length", &Gas::slit_length}, GasNumber{"far_gap", &Gas::far_gap},
    GasNumber{"damping", &Gas::damping},         GasNumber{"quality_factor", &Gas::quality_factor}};

}  // namespace

double end_flow(double ratio) {
  double sum = 0;
  for (int n = 39; n > 0; n -= 2) sum += std::tanh(n * pi / (2 * ratio)) / std::pow(n, 5);
  return 1 - 192 / std::pow(pi, 5) * ratio * sum;
}

Gas under_law(Gas gas, GasModel law) {
  const Gas absent;
  const Words& keys = row_of(gas_laws, law).keys;
  gas.model = law;
  for (const auto& [key, member] : keys_of_some_laws) {
    if (!keys.contain(key)) gas.*member = absent.*member;
  }
  return gas;
}

GasLaw gas_law(const Gas& gas, const Structure& s, double unit_quality) {
  const double kept = std::isnan(gas.film_length) ? 1 : end_flow(s.width / gas.film_length);
  return row_of(gas_laws, gas.model)
      .make({.gas = gas,
             .structure = s,
             .viscosity = viscosity(gas) * kept,
             .mean_free_path = mean_free_path(gas),
             .unit_quality = unit_quality});
}

double squeeze_number(const Gas& gas, double width, double gap, double rate) {
  return 12 * viscosity(gas) * width * width * rate / (gas.pressure * gap * gap);
}

double squeeze_number(const Device& device, const TrajectoryPoint& point) {
  const double h = device.gap.electrode - point.position;
  if (!device.gas || !std::isfinite(row_of(gas_laws, device.gas->model).most_squeeze) || !(h > 0)) return 0;
  return squeeze_number(*device.gas, device.structure.width, h, std::abs(point.velocity) / h);
}

std::vector<std::string> gas_warnings(const Device& device, double smallest_gap, double largest_squeeze) {
  std::vector<std::string> warnings;
  if (!device.gas) return warnings;
  const GasRow& law = row_of(gas_laws, device.gas->model);
  const double lambda = mean_free_path(*device.gas);
  const auto number = [](double value) { return engineering(value, "", 2); };
  if (const double kn = lambda / smallest_gap; kn > law.most_knudsen) {
    warnings.push_back(fmt::format("gas law {}: Knudsen number {} exceeds {}", law.name, number(kn), number(law.most_knudsen)));
  }
  if (const double kn = lambda / device.gap.electrode; kn < law.least_knudsen) {
    warnings.push_back(fmt::format("gas law {}: Knudsen number {} is below {}", law.name, number(kn), number(law.least_knudsen)));
  }
  if (largest_squeeze > law.most_squeeze) {
    warnings.push_back(fmt::format("gas law {}: squeeze number {} exceeds {}: {}", law.name, number(largest_squeeze),
                                   number(law.most_squeeze),
                                   is_compressible(law.value) ? "its boundary layers are too thin to be resolved"
                                                              : "the film is compressed, not squeezed out"));
  }
  return warnings;
}

}  // namespace softland
