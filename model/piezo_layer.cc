#include "model/piezo_layer.h"

#include <algorithm>
#include <cmath>

#include "model/built_beam.h"
#include "model/constants.h"
#include "waveforms/charging.h"

namespace softland {

double layer_capacitance(const Device& device) {
  if (!device.piezo) return std::nan("");
  const Piezo& layer = *device.piezo;
  const double begin = layer.begin.on(device.structure.length), end = layer.end.on(device.structure.length), length = end - begin;
  if (device.structure.is_built()) {
    double area = 0;
    for (const LocalSection& s : local_sections(device.structure)) {
      const double from = std::max(begin, s.begin), to = std::min(end, s.end);
      if (from < to) area += (to - from) * (s.width_at(from) + s.width_at(to)) / 2 * area_left(s.holes);
    }
    return vacuum_permittivity * layer.relative_permittivity * area / layer.thickness;
  }
  return vacuum_permittivity * layer.relative_permittivity * device.structure.width * length / layer.thickness;
}

double layer_charging_energy(const Device& device, std::span<const Signal> drives, double end) {
  const double capacitance = layer_capacitance(device);
  return std::isnan(capacitance) ? 0 : capacitance * charging(drives.back(), end);
}

}  // namespace softland
