#include "studies/closing/static_excess.h"

#include <fmt/format.h>

#include <limits>
#include <vector>

#include "base/engineering.h"
#include "model/pull_in.h"

namespace softland {
namespace {

bool stretches(const Structure& s) { return s.kind == StructureKind::clamped_clamped && s.stretching; }

std::string warning(const Scene& scene, std::size_t electrode, double voltage, double excess) {
  constexpr int digits = 4;
  return fmt::format(
      "structure.modes = {}: the static pull-in voltage of electrode {}, {}, is {} above that with {} modes, since a bridge "
      "that is bent by many thicknesses hangs like a membrane; dynamic pull-in and release are as uncertain",
      scene.device.structure.modes, scene.device.electrodes[electrode].name, engineering(voltage, "V", digits),
      engineering(100 * excess, "%", 2), most_static_modes);
}

}  // namespace

double resolved_pull_in(const Scene& scene, std::size_t electrode) {
  if (!stretches(scene.device.structure)) return std::numeric_limits<double>::quiet_NaN();
  SwitchOptions options = quadrature_for(SimulateOptions{}.accuracy, most_static_modes);
  options.modes = most_static_modes;
  return static_pull_in(Switch(scene.device, options), electrode, bias_of(scene, electrode)).voltage;
}

double static_excess(const Scene& scene, std::size_t electrode, double voltage) {
  return voltage / resolved_pull_in(scene, electrode) - 1;
}

std::vector<std::string> static_excess_warnings(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  if (!stretches(scene.device.structure)) return {};
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < scene.device.electrodes.size(); ++k) {
    const auto known = prepared.pull_in.find(scene.device.electrodes[k].name);
    const double voltage = known == prepared.pull_in.end() ? static_pull_in(prepared.model, k, bias_of(scene, k)).voltage
                                                           : known->second.statically.voltage;
    const double excess = static_excess(scene, k, voltage);
    if (excess > static_excess_worth_telling) warnings.push_back(warning(scene, k, voltage, excess));
  }
  return warnings;
}

}  // namespace softland
