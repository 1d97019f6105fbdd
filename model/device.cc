#include "model/device.h"

#include <fmt/format.h>

#include "base/require.h"

namespace softland {
namespace {

void positive(double value, const char* name) {
  require(value > 0 && value < 1e30, fmt::format("{} = {}: must be positive", name, value));
}

void span(double begin, double end, double length, const std::string& name) {
  require(begin >= 0 && end > begin && end <= length * (1 + 1e-12),
          fmt::format("{} = [{}, {}] m: must increase and lie on the beam [0, {}] m", name, begin, end, length));
}

}  // namespace

void validate(const Device& d) {
  const Structure& s = d.structure;
  positive(s.length, "structure.length");
  positive(s.width, "structure.width");
  positive(s.thickness, "structure.thickness");
  positive(s.youngs_modulus, "structure.youngs_modulus");
  positive(s.density, "structure.density");
  require(s.modes >= 1 && s.modes <= 20, fmt::format("structure.modes = {}: must be from 1 to 20", s.modes));
  require(s.damping_ratio >= 0 && s.damping_ratio < 1e3,
          fmt::format("structure.damping_ratio = {}: must not be negative", s.damping_ratio));
  require(!s.plate_strain || (s.poissons_ratio > -1 && s.poissons_ratio < 0.5),
          fmt::format("structure.poissons_ratio = {}: plate_strain needs one between -1 and 0.5", s.poissons_ratio));
  positive(d.gap.electrode, "gap.electrode");
  require(d.gap.contact > 0 && d.gap.contact < d.gap.electrode,
          fmt::format("gap.contact = {} m: must be positive and below gap.electrode = {} m", d.gap.contact, d.gap.electrode));
  for (const Electrode& e : d.electrodes) span(e.begin, e.end, s.length, "electrode." + e.name + ".span");
  if (d.gas) positive(d.gas->viscosity, "gas.viscosity");
  if (d.contact) {
    const Contact& c = *d.contact;
    require(c.pad_length > 0 && c.pad_length < s.length,
            fmt::format("contact.pad_length = {} m: must be positive and below the length {} m", c.pad_length, s.length));
    if (c.model == ContactModel::linear) {
      positive(c.stiffness, "contact.stiffness");
    } else {
      positive(c.asperity_radius, "contact.asperity_radius");
      positive(c.asperity_density, "contact.asperity_density");
      positive(c.asperity_height, "contact.asperity_height");
      positive(c.effective_modulus, "contact.effective_modulus");
    }
  }
  if (d.piezo) {
    const Piezo& p = *d.piezo;
    span(p.begin, p.end, s.length, "piezo.span");
    positive(p.thickness, "piezo.thickness");
    positive(p.youngs_modulus, "piezo.youngs_modulus");
    positive(p.density, "piezo.density");
    require(p.d31 > -1 && p.d31 < 1, fmt::format("piezo.d31 = {} m/V: must be a finite number below 1 m/V", p.d31));
  }
}

}  // namespace softland
