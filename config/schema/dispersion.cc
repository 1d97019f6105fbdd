#include "config/schema/sections.h"
#include "config/section_reader.h"

namespace softland::internal {
namespace {

Dispersion& dispersion(Scene& scene, std::size_t) { return *scene.device.dispersion; }
using OfDispersion = Of<dispersion>;

void check_dispersion(Scene& scene, const SectionReader& in, std::size_t) {
  const Gap& gap = scene.device.gap;
  in.require(scene.device.dispersion->equilibrium_distance < gap.electrode - gap.contact, "equilibrium_distance",
             "must be less than the closed gap, gap.electrode - gap.contact");
}

}  // namespace

Section dispersion_section() {
  return {
      .name = "dispersion",
      .may_vary = true,
      .selector = "model",
      .keys = {OfDispersion::choice<dispersion_models, &Dispersion::model>(
                   "model", "law of the force; auto: the smaller of the two at each gap, never the sum")
                   .needed(),
               OfDispersion::choice<conductors, &Dispersion::conductor>("conductor", "metal of the Casimir law")
                   .by_default("'ideal'")
                   .of({"casimir", "auto"}),
               OfDispersion::number<&Dispersion::hamaker_constant>(
                   "hamaker_constant", dimension::energy, positive,
                   "Hamaker constant of the pair of surfaces, a few 1e-19 J for metals")
                   .needed()
                   .of({"van-der-waals", "auto"})
                   .such_as("3e-19 J"),
               OfDispersion::number<&Dispersion::equilibrium_distance>(
                   "equilibrium_distance", dimension::length, not_negative,
                   "distance at which attraction and repulsion balance, less than gap.electrode - gap.contact; 0 m: no repulsion")
                   .by_default("'0 m'")
                   .of({"van-der-waals", "auto"})},
      .about = "Casimir and van der Waals forces between beam and electrode plane; absent: none",
      .begin =
          [](Scene& scene, const SectionReader&, std::string_view) {
            scene.device.dispersion.emplace();
            return std::size_t{0};
          },
      .check = check_dispersion};
}

}  // namespace softland::internal
