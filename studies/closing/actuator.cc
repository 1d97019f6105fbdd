#include "studies/closing/actuator.h"

#include <algorithm>

#include "base/require.h"

namespace softland {

bool has_pulling_electrode(const Device& device) {
  return std::any_of(device.electrodes.begin(), device.electrodes.end(), [](const Electrode& e) { return e.side != Side::far; });
}

std::string searched_electrode(const Device& device) {
  require_request(!device.electrodes.empty(), [&] {
    const std::string asked = requested("actuator");
    return asked + " electrostatic|both needs an electrode, and the scene has none" +
           (device.piezo        ? "; its piezo layer is searched with " + asked + " pzt"
            : device.dispersion ? "; the factor of a dispersion force is not searched"
                                : "");
  });
  for (const Electrode& e : device.electrodes) {
    if (e.name == "main" && e.side != Side::far) return e.name;
  }
  const auto pulling =
      std::find_if(device.electrodes.begin(), device.electrodes.end(), [](const Electrode& e) { return e.side != Side::far; });
  require(pulling != device.electrodes.end(),
          "optimize needs an electrode that pulls in, and all of the scene's are on the far side");
  return pulling->name;
}

std::size_t searched_drive(const Device& device) {
  const std::string name = searched_electrode(device);
  const auto at =
      std::find_if(device.electrodes.begin(), device.electrodes.end(), [&](const Electrode& e) { return e.name == name; });
  return static_cast<std::size_t>(at - device.electrodes.begin());
}

std::vector<std::string> braking_electrodes(const PreparedScene& prepared) {
  std::vector<std::string> names;
  for (const Electrode& e : prepared.scene.device.electrodes) {
    if (e.side == Side::far && prepared.drives.at(e.name).limits) names.push_back(e.name);
  }
  return names;
}

}  // namespace softland
