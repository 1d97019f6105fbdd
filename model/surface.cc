#include "model/surface.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "model/beam.h"

namespace softland {

std::string why_no_surface(const Device& d) {
  const Surface& surface = *d.surface;
  if (const std::string_view why = d.structure.why_no_skins(); !why.empty()) return std::string(why);
  if (d.structure.is_built()) return "is for a beam without sections and layers";
  if (d.piezo) return "is for a bare beam, and the piezo layer covers a face";
  if (!std::isfinite(surface.elastic_modulus) || !std::isfinite(surface.residual_stress))
    return "elastic_modulus and residual_stress must be finite";
  if (surface.cantilever_load != ResidualLoad::none && d.structure.has_far_clamp()) {
    return "cantilever_load is for a cantilever; between two clamps residual_stress is a tension";
  }
  const double rigidity = plain_section(d.structure, d.surface).rigidity;
  if (!(rigidity > 0)) return fmt::format("leaves a bending rigidity of {:.4g} N m^2, which must be above 0", rigidity);
  return why_buckled(d.structure, d.surface);
}

}  // namespace softland
