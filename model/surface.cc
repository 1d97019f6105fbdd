#include "model/surface.h"

#include <fmt/format.h>

#include <cmath>

#include "model/beam.h"

namespace softland {

std::string why_no_surface(const Device& d) {
  const Surface& surface = *d.surface;
  if (d.structure.kind == StructureKind::modes)
    return "skins change the modes, which a file cannot follow; a surface needs a beam";
  if (d.structure.kind == StructureKind::plate) return "a rigid plate does not bend; a surface needs a beam";
  if (d.piezo) return "is for a bare beam, and the piezo layer covers a face";
  if (!std::isfinite(surface.elastic_modulus) || !std::isfinite(surface.residual_stress)) return "must be finite";
  if (surface.cantilever_load != ResidualLoad::none && d.structure.kind != StructureKind::cantilever) {
    return "cantilever_load is for a cantilever; between two clamps residual_stress is a tension";
  }
  const double rigidity = plain_section(d.structure, d.surface).rigidity;
  if (!(rigidity > 0)) return fmt::format("leaves a bending rigidity of {:.4g} N m^2", rigidity);
  return why_buckled(d.structure, d.surface);
}

}  // namespace softland
