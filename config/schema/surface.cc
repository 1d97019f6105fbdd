#include "model/surface.h"

#include "config/schema/sections.h"
#include "config/section_reader.h"

namespace softland::internal {
namespace {

Surface& surface(Scene& scene, std::size_t) { return *scene.device.surface; }
using OfSurface = Of<surface>;

void check_surface(Scene& scene, const SectionReader& in, std::size_t) {
  if (const std::string wrong = why_no_surface(scene.device); !wrong.empty()) in.fail(wrong);
}

}  // namespace

Section surface_section() {
  return {.name = "surface",
          .may_vary = true,
          .keys = {OfSurface::number<&Surface::elastic_modulus>(
                       "elastic_modulus", dimension::stiffness, any,
                       "elastic modulus of the surfaces, of either sign, as long as a bending rigidity is left")
                       .by_default("'0 N/m'"),
                   OfSurface::number<&Surface::residual_stress>("residual_stress", dimension::stiffness, any,
                                                                "residual stress of the surfaces, positive in tension; "
                                                                "between two clamps a tension of the beam, which must not buckle")
                       .by_default("'0 N/m'"),
                   OfSurface::choice<surface_faces, &Surface::faces>(
                       "faces", "faces that have elastic_modulus; wide: upper and lower face only")
                       .by_default("'all'"),
                   OfSurface::choice<residual_loads, &Surface::cantilever_load>(
                       "cantilever_load",
                       "effect of residual_stress on a cantilever, on which the literature "
                       "disagrees: nothing, or a compression of the beam")
                       .by_default("'none'")},
          .about = "surfaces of a thin beam as elastic skins under stress, for a beam without piezo layer; absent: none",
          .begin =
              [](Scene& scene, const SectionReader&, std::string_view) {
                scene.device.surface.emplace();
                return std::size_t{0};
              },
          .check = check_surface};
}

}  // namespace softland::internal
