#include "config/schema/sections.h"
#include "config/section_reader.h"

namespace softland::internal {
namespace {

Piezo& piezo(Scene& scene, std::size_t) { return *scene.device.piezo; }
using OfPiezo = Of<piezo>;
constexpr Range at_least_one{.least = 1, .most = 1e6};

std::size_t begin_piezo(Scene& scene, const SectionReader& in, std::string_view) {
  if (const std::string_view why = scene.device.structure.why_no_layer(); !why.empty()) in.fail(why);
  if (scene.device.surface) in.fail("must not be combined with [surface], which is for a beam without layers");
  scene.device.piezo.emplace();
  return 0;
}

}  // namespace

Section piezo_section() {
  return {
      .name = "piezo",
      .may_vary = true,
      .keys = {OfPiezo::span<&Piezo::begin, &Piezo::end>("span", "begin and end, from the clamped end").needed(),
               OfPiezo::number<&Piezo::thickness>("thickness", dimension::length, positive, "of the layer").needed(),
               OfPiezo::number<&Piezo::youngs_modulus>("youngs_modulus", dimension::pressure, positive, "of the layer").needed(),
               OfPiezo::number<&Piezo::density>("density", dimension::density, positive, "of the layer").needed(),
               OfPiezo::number<&Piezo::d31>(
                   "d31", dimension::piezo_coefficient, any,
                   "piezoelectric coefficient, negative for the usual ceramics: a positive voltage lifts the tip")
                   .needed()
                   .instead("e31"),
               OfPiezo::number<&Piezo::e31>(
                   "e31", dimension::charge_density, any,
                   "stress per field, d31 youngs_modulus, instead of d31; smaller than youngs_modulus over 1 V/m")
                   .needed()
                   .instead("d31"),
               OfPiezo::number<&Piezo::relative_permittivity>(
                   "relative_permittivity", dimension::none, at_least_one,
                   "relative permittivity of the layer; absent: the drive energy excludes the charging of the layer")
                   .such_as("1500")},
      .about = "a piezoelectric layer as wide as the beam, a cantilever, on the face away from the electrode; absent: none",
      .begin = begin_piezo,
      .check = [](Scene& scene, const SectionReader& in, std::size_t) { in.require_on_beam("span", scene.device.structure); }};
}

}  // namespace softland::internal
