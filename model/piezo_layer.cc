#include "model/piezo_layer.h"

#include <cmath>

#include "model/constants.h"
#include "waveforms/charging.h"

namespace softland {

double layer_capacitance(const Device& device) {
  if (!device.piezo) return std::nan("");
  const Piezo& layer = *device.piezo;
  const double length = layer.end.on(device.structure.length) - layer.begin.on(device.structure.length);
  return vacuum_permittivity * layer.relative_permittivity * device.structure.width * length / layer.thickness;
}

double layer_charging_energy(const Device& device, std::span<const Signal> drives, double end) {
  const double capacitance = layer_capacitance(device);
  return std::isnan(capacitance) ? 0 : capacitance * charging(drives.back(), end);
}

}  // namespace softland
